# Packages of Debian 12; tools/install_deps.sh installs them.

# Outside a package config these make find_dependency() insist.
set(CMAKE_FIND_PACKAGE_NAME splitfusion)
set(splitfusion_FIND_REQUIRED TRUE)
include(LibraryDependencies)
unset(CMAKE_FIND_PACKAGE_NAME)
unset(splitfusion_FIND_REQUIRED)
message(STATUS "Libraries: Ceres ${Ceres_VERSION}, Eigen ${Eigen3_VERSION}, "
               "OpenCV ${OpenCV_VERSION}, OpenVDB ${OpenVDB_VERSION}, "
               "PCL ${PCL_VERSION}, TBB ${TBB_VERSION}")

# CHOLMOD comes with Ceres, without a package config of its own.
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)

# Nor has xxHash, which tells files apart and finds damaged ones.
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
find_library(XXHASH_LIBRARY xxhash REQUIRED)

# Nor has minizip, which packs arrays for NumPy.
find_path(MINIZIP_INCLUDE_DIR minizip/zip.h REQUIRED)
find_library(MINIZIP_LIBRARY minizip REQUIRED)

# Nor has HDF5 one of Debian's; FindHDF5 asks whatever h5cc comes first, which
# may be that of MPI.
find_path(HDF5_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/serial REQUIRED)
find_library(HDF5_LIBRARY hdf5_serial REQUIRED)

# Bags of ROS 1, optional. The package configs of librosbag-storage-dev run
# Python with packages that another Python than Debian's lacks; its pkg-config
# file names one that is not there. SPLITFUSION_ROSBAG: whether all was found.
option(SPLITFUSION_WITH_ROSBAG
       "Read bags of ROS 1, if librosbag-storage is there" ON)
set(SPLITFUSION_ROSBAG OFF)
if(SPLITFUSION_WITH_ROSBAG)
  set(SPLITFUSION_ROSBAG ON)
  set(ROSBAG_INCLUDE_DIRS "")
  foreach(header rosbag/bag sensor_msgs/Image
          ament_index_cpp/get_package_prefix class_loader/class_loader
          pluginlib/class_loader rcpputils/visibility_control rcutils/macros)
    get_filename_component(name ${header} DIRECTORY)
    find_path(ROSBAG_${name}_INCLUDE_DIR NAMES ${header}.h ${header}.hpp
              PATH_SUFFIXES ${name})
    mark_as_advanced(ROSBAG_${name}_INCLUDE_DIR)
    list(APPEND ROSBAG_INCLUDE_DIRS "${ROSBAG_${name}_INCLUDE_DIR}")
  endforeach()
  set(ROSBAG_LIBRARIES "")
  foreach(name rosbag_storage roscpp_serialization rostime cpp_common
          console_bridge)
    find_library(ROSBAG_${name}_LIBRARY ${name})
    mark_as_advanced(ROSBAG_${name}_LIBRARY)
    list(APPEND ROSBAG_LIBRARIES "${ROSBAG_${name}_LIBRARY}")
  endforeach()
  list(REMOVE_DUPLICATES ROSBAG_INCLUDE_DIRS)
  if("${ROSBAG_INCLUDE_DIRS};${ROSBAG_LIBRARIES}" MATCHES "NOTFOUND")
    set(SPLITFUSION_ROSBAG OFF)
    message(STATUS "Bags of ROS 1: not read (librosbag-storage-dev and "
                   "libsensor-msgs-dev were not found)")
  else()
    message(STATUS "Bags of ROS 1: read by ${ROSBAG_rosbag_storage_LIBRARY}")
  endif()
else()
  message(STATUS "Bags of ROS 1: not read (SPLITFUSION_WITH_ROSBAG=OFF)")
endif()

if(SPLITFUSION_BUILD_TOOLS)
  find_package(gflags REQUIRED)
  find_package(glog REQUIRED)
endif()
if(SPLITFUSION_BUILD_TESTS)
  find_package(GTest REQUIRED)
endif()
if(SPLITFUSION_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()

# OpenVDB and PCL stay out of the public headers. PCL's libraries are taken by
# name: its list of all of them drags VTK and Qt in.
function(splitfusion_link_dependencies target)
  target_link_libraries(${target}
    PUBLIC Eigen3::Eigen Ceres::ceres opencv_core opencv_imgproc
           opencv_imgcodecs TBB::tbb nlohmann_json::nlohmann_json
    PRIVATE opencv_dnn opencv_features2d opencv_video OpenVDB::openvdb
            pcl_kdtree pcl_sample_consensus cholmod
            SQLite::SQLite3 ZLIB::ZLIB meshoptimizer::meshoptimizer
            ${XXHASH_LIBRARY} ${HDF5_LIBRARY} ${MINIZIP_LIBRARY})
  target_include_directories(${target} SYSTEM PRIVATE ${PCL_INCLUDE_DIRS}
                             ${CHOLMOD_INCLUDE_DIR} ${XXHASH_INCLUDE_DIR}
                             ${HDF5_INCLUDE_DIR} ${MINIZIP_INCLUDE_DIR})
  if(SPLITFUSION_ROSBAG)
    target_link_libraries(${target} PRIVATE ${ROSBAG_LIBRARIES})
  endif()
endfunction()

# Leaves those source files in a list that are for a build with, or without,
# librosbag-storage. For sources of the calling folder.
function(splitfusion_choose_rosbag_files list)
  if(SPLITFUSION_ROSBAG)
    set(other "/ros_bag_missing.cc$")
  else()
    set(other "/(ros_bag|ros_bag_check).cc$")
  endif()
  list(FILTER ${list} EXCLUDE REGEX "${other}")
  set(${list} "${${list}}" PARENT_SCOPE)
  list(FILTER ${list} INCLUDE
       REGEX "/(ros_bag|ros_bag_check|ros_bag_missing).cc$")
  splitfusion_let_include_ros(${${list}})
endfunction()

# Only these files see the headers of ROS. Those define macros and drag others
# in: who includes them is compiled alone.
function(splitfusion_let_include_ros)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  if(SPLITFUSION_ROSBAG)
    # GCC's own headers look for the next ones after the usual folders.
    list(REMOVE_ITEM ROSBAG_INCLUDE_DIRS
         ${CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES})
    list(TRANSFORM ROSBAG_INCLUDE_DIRS PREPEND -isystem)
    set_source_files_properties(${ARGN} PROPERTIES
      COMPILE_OPTIONS "${ROSBAG_INCLUDE_DIRS}"
      COMPILE_DEFINITIONS SPLITFUSION_WITH_ROSBAG)
  endif()
endfunction()
