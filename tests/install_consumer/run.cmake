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
    "--terms=point_to_plane arap(weight=8) stretch(weight=2,least=0.01)")
run("${bin}/sf_run" "--terms_library=${stretch}/libstretch.so"
    "--output=${STAGE_DIR}/library" ${arguments})
run("${stretch}/sf_run_stretch" "--output=${STAGE_DIR}/program" ${arguments})
foreach(run library program)
  file(READ "${STAGE_DIR}/${run}/frames.jsonl" frames)
  string(REGEX MATCHALL
    "\"term\": ?\"stretch\", ?\"residual_vectors\": ?[1-9][^}]*" ${run}
    "${frames}")
  if(NOT ${run})
    message(FATAL_ERROR "${run}: no residuals of the term in frames.jsonl")
  endif()
endforeach()
if(NOT library STREQUAL program)
  message(FATAL_ERROR "library and program differ: ${library}\n${program}")
endif()

# A term that looks at frames before: in the run of its name it has residuals in
# the third frame, and in none before.
function(expect_from_third_frame term)
  file(STRINGS "${STAGE_DIR}/${term}/frames.jsonl" frames)
  foreach(frame RANGE 2)
    list(GET frames ${frame} line)
    string(REGEX MATCH
      "\"term\": ?\"${term}\", ?\"residual_vectors\": ?[1-9]" found
      "${line}")
    if((frame LESS 2 AND found) OR (frame EQUAL 2 AND NOT found))
      message(FATAL_ERROR "frame ${frame}: residuals of ${term}: '${found}'")
    endif()
  endforeach()
endfunction()

# A term over three frames, of persons only.
run("${bin}/sf_run"
    "--terms_library=${stretch}/libstretch.so,${stretch}/libsteady.so"
    "--set=person.terms.steady.weight=2" "--output=${STAGE_DIR}/steady"
    "--sequence=${STAGE_DIR}/sequence")
expect_from_third_frame(steady)

# A term that keeps features from frame to frame: the first pairs are those of
# the second frame in which the person is tracked.
run("${bin}/sf_synth" --frames=3 --width=320 --height=240
    "--output=${STAGE_DIR}/larger")
run("${bin}/sf_run" "--terms_library=${stretch}/liborb.so"
    --set=terms.orb.weight=1 "--output=${STAGE_DIR}/orb"
    "--sequence=${STAGE_DIR}/larger")
expect_from_third_frame(orb)

# A term with an unknown of its own, whose estimates are in the report.
run("${bin}/sf_run" "--terms_library=${stretch}/libbrightness.so"
    "--output=${STAGE_DIR}/unknown" "--sequence=${STAGE_DIR}/sequence"
    "--terms=point_to_plane arap(weight=8) brightness")
file(READ "${STAGE_DIR}/unknown/frames.jsonl" frames)
string(REGEX MATCHALL
  "\"term\": ?\"brightness\", ?\"name\": ?\"gain\"[^}]*" gains "${frames}")
list(REMOVE_DUPLICATES gains)
list(LENGTH gains count)
if(count LESS 2)
  message(FATAL_ERROR "no gains were estimated: ${gains}")
endif()

# What the library holds decides the result, and not where it lies.
function(identity library result)
  run("${bin}/sf_run" "--terms_library=${library}" --print_identity
      ${arguments})
  string(REGEX MATCH "\"identity\": ?\"[0-9a-f]+\"" identity "${output}")
  set(${result} "${identity}" PARENT_SCOPE)
endfunction()
file(COPY "${stretch}/libstretch.so" DESTINATION "${STAGE_DIR}/copy")
file(COPY "${stretch}/libstretch.so" DESTINATION "${STAGE_DIR}/changed")
file(APPEND "${STAGE_DIR}/changed/libstretch.so" "x")
identity("${stretch}/libstretch.so" built)
identity("${STAGE_DIR}/copy/libstretch.so" copied)
identity("${STAGE_DIR}/changed/libstretch.so" changed)
if(NOT built OR NOT built STREQUAL copied OR built STREQUAL changed)
  message(FATAL_ERROR "identities: ${built}, ${copied}, ${changed}")
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
extern \"C\" {
extern const char SplitFusionTermsBuild[];
const char SplitFusionTermsBuild[] = \"splitfusion 0.0.9 (0), compiler 11\";
void SplitFusionAddTerms(void*) { __builtin_trap(); }
}
")
run(c++ -shared -fPIC "${STAGE_DIR}/older.cc" -o "${STAGE_DIR}/older.so")
file(WRITE "${STAGE_DIR}/empty.cc" "int empty;")
run(c++ -shared -fPIC "${STAGE_DIR}/empty.cc" -o "${STAGE_DIR}/empty.so")
refuse("${STAGE_DIR}/older.so"
       "older.so: built with splitfusion 0.0.9 .*: expected splitfusion 0.1")
refuse("${STAGE_DIR}/empty.so" "expected a library with SPLITFUSION_TERMS_LIB")
refuse("${STAGE_DIR}/older.cc" "older.cc: cannot be loaded: ")
refuse("${STAGE_DIR}/none.so" "none.so: no such file: expected a shared library")
refuse("${stretch}/libstretch.so,${stretch}/libstretch.so"
       "libstretch.so: term 'stretch': already registered")
refuse("${stretch}/libstretch.so,,x.so" "expected files, separated by commas")
