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
endfunction()
