# Compiler options of the whole project.

option(SPLITFUSION_SANITIZE "Address and undefined-behaviour sanitizers" OFF)

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

function(splitfusion_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wno-comment)
  if(SPLITFUSION_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(SPLITFUSION_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=address,undefined
                           -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endif()
endfunction()

# Files that include OpenVDB go without the undefined-behaviour sanitizer: it
# multiplies their compile time (minutes and gigabytes each).
function(splitfusion_spare_openvdb_files)
  if(NOT SPLITFUSION_SANITIZE)
    return()
  endif()
  foreach(source ${ARGN})
    file(STRINGS "${source}" openvdb
         REGEX "include.*(openvdb/|tsdf/internal/(grids|leaf_mesh|padded_leaf))")
    if(openvdb)
      set_source_files_properties("${source}" PROPERTIES
        COMPILE_OPTIONS -fno-sanitize=undefined)
    endif()
  endforeach()
endfunction()
