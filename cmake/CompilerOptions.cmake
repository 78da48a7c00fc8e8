# Compiler options of the whole project.

set(SPLITFUSION_SANITIZE "" CACHE STRING
    "Sanitizers of the whole build: address (with undefined) or thread")
set_property(CACHE SPLITFUSION_SANITIZE PROPERTY STRINGS "" address thread)
set(SPLITFUSION_SANITIZER_address -fsanitize=address,undefined)
set(SPLITFUSION_SANITIZER_thread -fsanitize=thread)

# Eigen changes the alignment of its types with the instruction set, and
# Debian's libceres and PCL were built for the baseline: code that shares Eigen
# types with them crashes when it is built for another one. Hot loops that need
# wide vectors use __attribute__((target_clones)) in files free of Eigen.
foreach(flags "${CMAKE_CXX_FLAGS}" "${CMAKE_CXX_FLAGS_RELEASE}"
        "${CMAKE_CXX_FLAGS_DEBUG}" "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}"
        "${CMAKE_CXX_FLAGS_MINSIZEREL}" "${CMAKE_CXX_COMPILER_ARG1}"
        "$ENV{CXXFLAGS}")
  if(flags MATCHES "-march=|-mavx|-mfma")
    message(FATAL_ERROR
      "C++ flags '${flags}' name an instruction set (-march, -mavx, -mfma): "
      "Eigen types shared with Debian's Ceres and PCL would get another "
      "alignment and crash. Remove the flag.")
  endif()
endforeach()

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

# Builds a target under a sanitizer: `address` (with undefined) or `thread`.
function(splitfusion_sanitize target sanitizer)
  set(flags ${SPLITFUSION_SANITIZER_${sanitizer}})
  if(NOT flags)
    message(FATAL_ERROR "SPLITFUSION_SANITIZE = ${sanitizer}: expected address "
                        "or thread")
  endif()
  target_compile_options(${target} PRIVATE ${flags} -fno-omit-frame-pointer
                         -fno-sanitize-recover=all)
  target_link_options(${target} PRIVATE ${flags})
endfunction()

function(splitfusion_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wno-comment)
  if(SPLITFUSION_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Of classes that a source file defines for itself: no header holds them.
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
  if(SPLITFUSION_SANITIZE)
    splitfusion_sanitize(${target} ${SPLITFUSION_SANITIZE})
  endif()
endfunction()

# Parsing the same few headers again is a quarter of the time of a build. What a
# file uses it includes all the same: without SPLITFUSION_PRECOMPILE it must
# compile, too. More headers may be given.
function(splitfusion_precompile target)
  if(SPLITFUSION_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE
      <Eigen/Core> <Eigen/Geometry> <opencv2/core.hpp> <algorithm> <cmath>
      <functional> <map> <memory> <optional> <string> <vector> ${ARGN})
  endif()
endfunction()

# Files that include OpenVDB go without the checks of the undefined-behaviour
# sanitizer that every member call needs: in OpenVDB's templates they multiply
# the compile time (minutes and gigabytes each). Those of arithmetic and bounds
# stay. For sources of the calling folder.
function(splitfusion_spare_openvdb_files)
  foreach(source ${ARGN})
    file(STRINGS "${source}" openvdb
         REGEX "include.*(openvdb/|tsdf/internal/(grids|leaf_mesh|padded_leaf))")
    if(openvdb)
      # Under other options precompiled headers would not do.
      set_source_files_properties("${source}" PROPERTIES
        SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS
        "-fno-sanitize=null,vptr,alignment,object-size,nonnull-attribute,returns-nonnull-attribute")
    endif()
  endforeach()
endfunction()

# Unity builds (CMAKE_UNITY_BUILD), which tools/build_release.sh makes, take half
# the time: a few files are compiled as one. Files with optimisation pragmas of
# their own stay alone, and read their headers below these pragmas: functions of
# headers precompiled without them, std::max too, are not inlined, and the loops
# that call them not vectorised. For sources of the calling folder.
function(splitfusion_keep_apart)
  foreach(source ${ARGN})
    file(STRINGS "${source}" pragmas
         REGEX "include.*base/vector_clones.h|pragma GCC optimize")
    if(pragmas)
      set_source_files_properties("${source}" PROPERTIES
        SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
endfunction()
