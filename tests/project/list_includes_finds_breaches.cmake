# Test: list_includes finds each kind of breach and chains that are too long, and
# nothing in good code.
#   cmake -D WORK_DIR=... -P list_includes_finds_breaches.cmake
function(list_includes file text)
  file(REMOVE_RECURSE "${WORK_DIR}")
  file(WRITE "${WORK_DIR}/${file}" "${text}")
  execute_process(
    COMMAND "${CMAKE_CURRENT_LIST_DIR}/../../tools/list_includes.py"
            "${WORK_DIR}"
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  set(result "${result}" PARENT_SCOPE)
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(expect_breach file text message)
  list_includes("${file}" "${text}")
  if(result EQUAL 0 OR NOT output MATCHES "${message}")
    message(SEND_ERROR "not found: ${file}: ${text}\n${output}")
  endif()
endfunction()

function(expect_clean file text)
  list_includes("${file}" "${text}")
  if(NOT result EQUAL 0)
    message(SEND_ERROR "rejected: ${file}: ${text}\n${output}")
  endif()
endfunction()

expect_breach(lib/geometry/a.h "#include \"splitfusion/lib/energy/b.h\"\n"
              "geometry may not include lib/energy")
expect_breach(lib/tsdf/a.cc "#include \"splitfusion/lib/sequence/b.h\"\n"
              "tsdf may not include lib/sequence")
expect_breach(lib/report/a.cc "#include \"splitfusion/pipelines/b.h\"\n"
              "report may not include pipelines")
expect_breach(lib/tsdf/a.h "#include <openvdb/openvdb.h>\n" "only .cc files")
expect_breach(pipelines/a.h "#include <pcl/point_cloud.h>\n" "only .cc files")
expect_breach(lib/tsdf/a.h "#include \"splitfusion/lib/tsdf/internal/b.h\"\n"
              "public header includes")
expect_breach(lib/base/a.cc "#include <gflags/gflags.h>\n" "only tools/ may")
expect_breach(pipelines/a.cc "#include <glog/logging.h>\n" "only tools/ may")
expect_breach(lib/base/a.cc "#include \"error.h\"\n" "write \"splitfusion/")
expect_breach(lib/news/a.h "\n" "news is not listed")

expect_clean(lib/tsdf/a.cc "#include <openvdb/openvdb.h>\n")
expect_clean(lib/tsdf/internal/a.h "#include <openvdb/openvdb.h>\n")
expect_clean(lib/tsdf/a.cc "#include \"splitfusion/lib/tsdf/internal/b.h\"\n")
expect_clean(lib/segmentation/a.h
             "#include \"splitfusion/lib/sequence/frame.h\"\n")
expect_clean(pipelines/a.h "#include \"splitfusion/cost_functions/arap.h\"\n")
expect_clean(tools/sf_a.cc "#include <gflags/gflags.h>\n")

# A chain of nine includes is let through, one of ten is not.
function(expect_chain includes result)
  file(REMOVE_RECURSE "${WORK_DIR}")
  foreach(link RANGE 1 ${includes})
    math(EXPR next "${link} + 1")
    file(WRITE "${WORK_DIR}/lib/base/h${link}.h"
         "#include \"splitfusion/lib/base/h${next}.h\"\n")
  endforeach()
  file(WRITE "${WORK_DIR}/lib/base/h${next}.h" "\n")
  execute_process(
    COMMAND "${CMAKE_CURRENT_LIST_DIR}/../../tools/list_includes.py"
            "${WORK_DIR}"
    RESULT_VARIABLE status OUTPUT_VARIABLE output)
  if(NOT status EQUAL result OR NOT output MATCHES "has ${includes} includes")
    message(SEND_ERROR "a chain of ${includes}: exit ${status}\n${output}")
  endif()
endfunction()
expect_chain(9 0)
expect_chain(10 1)
