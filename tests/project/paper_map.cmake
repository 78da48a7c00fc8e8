# Holds docs/paper_map.md against the tree: the files and the tests that it
# names must exist, and every link to a section must have its anchor.
#
# cmake -D ROOT=<source folder> -P paper_map.cmake
cmake_minimum_required(VERSION 3.18)
file(READ "${ROOT}/docs/paper_map.md" map)

set(missing "")
string(REGEX MATCHALL "`(lib|cost_functions|pipelines|tests)/[a-z_/]+\\.(h|cc)`"
       files "${map}")
foreach(file ${files})
  string(REPLACE "`" "" file "${file}")
  if(NOT EXISTS "${ROOT}/${file}")
    list(APPEND missing "file ${file}")
  endif()
endforeach()

set(sources "")
file(GLOB_RECURSE test_files "${ROOT}/tests/*_test.cc")
foreach(test_file ${test_files})
  file(READ "${test_file}" text)
  string(REGEX MATCHALL
         "TEST(_F|_P)?\\([A-Za-z]+,[ \n]*[A-Za-z0-9]+" found "${text}")
  list(APPEND sources ${found})
endforeach()
list(TRANSFORM sources REPLACE "^TEST(_F|_P)?\\(" "")
list(TRANSFORM sources REPLACE ",[ \n]*" ".")
string(REGEX MATCHALL "`[A-Z][A-Za-z]+\\.[A-Z][A-Za-z]+`" tests "${map}")
foreach(test ${tests})
  string(REPLACE "`" "" test "${test}")
  if(NOT test IN_LIST sources)
    list(APPEND missing "test ${test}")
  endif()
endforeach()

string(REGEX MATCHALL "\\(#[a-z0-9-]+\\)" links "${map}")
foreach(link ${links})
  string(REGEX REPLACE "[(#)]" "" anchor "${link}")
  if(NOT map MATCHES "<a id=\"${anchor}\"></a>")
    list(APPEND missing "anchor ${anchor}")
  endif()
endforeach()

list(LENGTH files file_count)
list(LENGTH tests test_count)
if(missing OR file_count LESS 20 OR test_count LESS 20)
  list(JOIN missing "\n  " missing)
  message(FATAL_ERROR "docs/paper_map.md names ${file_count} files and "
          "${test_count} tests; these do not exist:\n  ${missing}")
endif()
