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

# The template of a project with a term of its own, both ways of using it, and a
# library that was built with something else.
set(stretch "${STAGE_DIR}/term_project")
run(${CMAKE_COMMAND} -G Ninja
    -S "${CMAKE_CURRENT_LIST_DIR}/../../examples/term_project" -B "${stretch}"
    "-DCMAKE_PREFIX_PATH=${STAGE_DIR}/prefix" -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build "${stretch}")
set(bin "${STAGE_DIR}/prefix/bin")
run("${bin}/sf_synth" --frames=3 --width=160 --height=120
    "--output=${STAGE_DIR}/sequence")
set(arguments "--sequence=${STAGE_DIR}/sequence"
    "--set=terms.stretch.weight=2\; terms.stretch.least=0.01")
run("${bin}/sf_run" "--terms_library=${stretch}/libstretch.so"
    "--output=${STAGE_DIR}/library" ${arguments})
run("${stretch}/sf_run_stretch" "--output=${STAGE_DIR}/program" ${arguments})
foreach(run library program)
  file(READ "${STAGE_DIR}/${run}/frames.jsonl" frames)
  if(NOT frames MATCHES "\"stretch\"")
    message(FATAL_ERROR "${run}: frames.jsonl does not name the term")
  endif()
endforeach()
file(READ "${STAGE_DIR}/library/trajectory.txt" library)
file(READ "${STAGE_DIR}/program/trajectory.txt" program)
if(NOT library STREQUAL program)
  message(FATAL_ERROR "library and program give different trajectories")
endif()

# Libraries that must not be called into.
function(refuse library message)
  execute_process(COMMAND "${bin}/sf_run" "--terms_library=${library}"
                  --help_terms RESULT_VARIABLE result ERROR_VARIABLE errors
                  OUTPUT_QUIET)
  if(NOT result EQUAL 2 OR NOT errors MATCHES "${message}")
    message(FATAL_ERROR "${library}: exit ${result}, ${errors}")
  endif()
endfunction()

file(WRITE "${STAGE_DIR}/older.cc" "
struct Library { const char* build; void (*add)(void*); };
extern \"C\" Library SplitFusionTerms() {
  return {\"splitfusion 0.0.9 (0), compiler 11\", nullptr};
}
")
run(c++ -shared -fPIC "${STAGE_DIR}/older.cc" -o "${STAGE_DIR}/older.so")
file(WRITE "${STAGE_DIR}/empty.cc" "int empty;")
run(c++ -shared -fPIC "${STAGE_DIR}/empty.cc" -o "${STAGE_DIR}/empty.so")
refuse("${STAGE_DIR}/older.so"
       "older.so: built with splitfusion 0.0.9 .*: expected splitfusion 0.1")
refuse("${STAGE_DIR}/empty.so" "expected a library with SPLITFUSION_TERMS_LIB")
refuse("${STAGE_DIR}/older.cc" "older.cc: cannot be loaded: ")
refuse("${STAGE_DIR}/none.so" "none.so: expected a shared library")
refuse("${stretch}/libstretch.so,${stretch}/libstretch.so"
       "term 'stretch': already registered")
