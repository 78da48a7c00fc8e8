# Packages of Debian 12; tools/install_deps.sh installs them.

# FindOpenVDB.cmake is not in CMake's default path.
list(APPEND CMAKE_MODULE_PATH "/usr/lib/x86_64-linux-gnu/cmake/OpenVDB"
     "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB")

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Ceres 2.1 REQUIRED COMPONENTS SuiteSparse)
find_package(OpenCV 4.5 REQUIRED COMPONENTS core imgproc imgcodecs)
find_package(PCL 1.12 REQUIRED COMPONENTS common kdtree)
find_package(OpenVDB 10 REQUIRED)
find_package(TBB REQUIRED)
find_package(gflags REQUIRED)
find_package(glog REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
if(SPLITFUSION_BUILD_TESTS)
  find_package(GTest REQUIRED)
endif()
if(SPLITFUSION_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()

# OpenVDB and PCL stay out of the public headers. PCL's libraries are taken by
# name: its imported targets drag VTK and Qt in.
function(splitfusion_link_dependencies target)
  target_link_libraries(${target}
    PUBLIC Eigen3::Eigen Ceres::ceres opencv_core opencv_imgproc
           opencv_imgcodecs TBB::tbb nlohmann_json::nlohmann_json
    PRIVATE OpenVDB::openvdb pcl_kdtree)
  target_include_directories(${target} SYSTEM PRIVATE ${PCL_INCLUDE_DIRS})
endfunction()
