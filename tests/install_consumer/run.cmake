# Test: installs the build into a fresh folder, then configures, builds and runs
# the project beside this file with nothing but that folder.
#   cmake -D BUILD_DIR=... -D STAGE_DIR=... -P run.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGN}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${STAGE_DIR}")
run(${CMAKE_COMMAND} --install "${BUILD_DIR}" --prefix "${STAGE_DIR}/prefix")
run(${CMAKE_COMMAND} -G Ninja -S "${CMAKE_CURRENT_LIST_DIR}"
    -B "${STAGE_DIR}/build" "-DCMAKE_PREFIX_PATH=${STAGE_DIR}/prefix"
    -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build "${STAGE_DIR}/build")
run("${STAGE_DIR}/build/consumer")
message("${output}")
