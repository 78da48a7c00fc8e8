# Test: who may include whom. Data walks one way, see CONTRIBUTING.md.
# Headers in a folder named internal are not installed: they alone may include
# OpenVDB and PCL, and no public header includes them.
#   cmake -D ROOT=<repository> -P layering.cmake
cmake_minimum_required(VERSION 3.18)

# A module includes itself, modules of the levels before its own, and what is
# listed for it below.
set(level_0 base)
set(level_1 geometry)
set(level_2 sequence segmentation deformation tsdf)
set(level_3 split render association energy)
set(level_4 evaluation report cost_functions synthetic)
set(level_5 pipelines experiment)
set(level_6 tools examples)

# Within one level.
set(segmentation_may_include sequence)
set(tsdf_may_include deformation)
set(energy_may_include association)

function(breach file text)
  message(SEND_ERROR "${file}: ${text}")
endfunction()

foreach(level RANGE 0 6)
  foreach(module ${level_${level}})
    set(level_of_${module} ${level})
  endforeach()
endforeach()

# lib/energy/solver.h -> energy, pipelines/presets.h -> pipelines.
function(module_of path module)
  string(REGEX REPLACE "^(lib/)?([^/]+)/.*" "\\2" name "${path}")
  set(${module} "${name}" PARENT_SCOPE)
endfunction()

function(check_own_include file module included)
  module_of("${included}" other)
  # Headers of tools/ are not installed.
  if(included MATCHES "/internal/" AND NOT module STREQUAL "tools" AND
     NOT file MATCHES "\\.cc$|/internal/")
    breach("${file}" "public header includes ${included}, not installed")
  elseif(NOT DEFINED level_of_${other})
    breach("${file}" "includes ${included}, a module that is not listed")
  elseif(other STREQUAL module OR other IN_LIST ${module}_may_include)
    return()
  elseif(NOT level_of_${other} LESS level_of_${module})
    breach("${file}" "${module} may not include ${other} (${included})")
  endif()
endfunction()

function(check_foreign_include file module included)
  if(included MATCHES "^(gflags|glog)/" AND NOT module STREQUAL "tools")
    breach("${file}" "includes ${included}: only tools/ may")
  elseif(included MATCHES "^(openvdb|pcl)/" AND file MATCHES "\\.h$" AND
         NOT file MATCHES "/internal/")
    breach("${file}" "includes ${included}: only .cc files may")
  endif()
endfunction()

file(GLOB_RECURSE files RELATIVE "${ROOT}"
     "${ROOT}/lib/*.h" "${ROOT}/lib/*.cc"
     "${ROOT}/cost_functions/*.h" "${ROOT}/cost_functions/*.cc"
     "${ROOT}/pipelines/*.h" "${ROOT}/pipelines/*.cc"
     "${ROOT}/tools/*.h" "${ROOT}/tools/*.cc" "${ROOT}/examples/*.cc")
if(NOT files)
  message(FATAL_ERROR "no sources under ${ROOT}")
endif()
foreach(file ${files})
  module_of("${file}" module)
  if(NOT DEFINED level_of_${module})
    breach("${file}" "${module} is not listed in any level")
    continue()
  endif()
  file(STRINGS "${ROOT}/${file}" includes REGEX "^ *# *include ")
  foreach(line ${includes})
    string(REGEX REPLACE ".*[<\"](.*)[>\"].*" "\\1" included "${line}")
    if(included MATCHES "^splitfusion/(.*)")
      check_own_include("${file}" "${module}" "${CMAKE_MATCH_1}")
    elseif(line MATCHES "\"" AND NOT module STREQUAL "tools")
      breach("${file}" "includes \"${included}\": write \"splitfusion/...\"")
    else()
      check_foreign_include("${file}" "${module}" "${included}")
    endif()
  endforeach()
endforeach()
list(LENGTH files count)
message("layering: ${count} files looked at")
