# Test: the compiler options refuse flags that change Eigen's alignment, however
# they are given, and take others.
#   cmake -D OPTIONS_FILE=cmake/CompilerOptions.cmake -P <this file>
function(configure_with flags)
  execute_process(COMMAND ${CMAKE_COMMAND} ${flags} -P "${OPTIONS_FILE}"
                  RESULT_VARIABLE result OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  set(result "${result}" PARENT_SCOPE)
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(expect_refused flags)
  configure_with("${flags}")
  if(result EQUAL 0 OR NOT output MATCHES "name an instruction set")
    message(SEND_ERROR "not refused: ${flags} CXXFLAGS=$ENV{CXXFLAGS}\n"
                       "${output}")
  endif()
endfunction()

function(expect_accepted flags)
  configure_with("${flags}")
  if(NOT result EQUAL 0)
    message(SEND_ERROR "refused: ${flags}\n${output}")
  endif()
endfunction()

unset(ENV{CXXFLAGS})
expect_refused("-DCMAKE_CXX_FLAGS=-O2 -march=native")
expect_refused("-DCMAKE_CXX_FLAGS=-mavx2")
expect_refused("-DCMAKE_CXX_FLAGS_RELEASE=-O3 -mavx512f")
expect_refused("-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-mfma")
expect_refused("-DCMAKE_CXX_COMPILER_ARG1= -march=native")
expect_accepted("-DCMAKE_CXX_FLAGS=-O2 -g -mtune=generic")

set(ENV{CXXFLAGS} "-march=haswell")
expect_refused("-DCMAKE_CXX_FLAGS=-O2")
