# Test: the layering check finds each kind of breach, and nothing in good code.
#   cmake -D WORK_DIR=... -P layering_finds_breaches.cmake
function(check_layering file text)
  file(REMOVE_RECURSE "${WORK_DIR}")
  file(WRITE "${WORK_DIR}/${file}" "${text}")
  execute_process(
    COMMAND ${CMAKE_COMMAND} -D "ROOT=${WORK_DIR}"
            -P "${CMAKE_CURRENT_LIST_DIR}/layering.cmake"
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  set(result "${result}" PARENT_SCOPE)
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(expect_breach file text message)
  check_layering("${file}" "${text}")
  if(result EQUAL 0 OR NOT output MATCHES "${message}")
    message(SEND_ERROR "not found: ${file}: ${text}\n${output}")
  endif()
endfunction()

function(expect_clean file text)
  check_layering("${file}" "${text}")
  if(NOT result EQUAL 0)
    message(SEND_ERROR "rejected: ${file}: ${text}\n${output}")
  endif()
endfunction()

expect_breach(lib/geometry/a.h "#include \"splitfusion/lib/energy/b.h\"\n"
              "geometry may not include energy")
expect_breach(lib/tsdf/a.cc "#include \"splitfusion/lib/sequence/b.h\"\n"
              "tsdf may not include sequence")
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
