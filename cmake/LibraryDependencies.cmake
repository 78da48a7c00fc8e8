# Packages of the library itself, one list for this project and for whoever
# uses the installed library: find_package(splitfusion) includes this file too.
include(CMakeFindDependencyMacro)

# These packages print pages while they are found, some of them alarming and
# none of them needed when all goes well. Warnings and errors still show.
set(splitfusion_log_level "${CMAKE_MESSAGE_LOG_LEVEL}")
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)

# TBB by its own config file, before FindOpenVDB defines half of its targets.
find_dependency(TBB CONFIG)

# Debian keeps FindOpenVDB.cmake outside CMake's default path. It also changes
# BUILD_SHARED_LIBS, which is none of its business.
set(splitfusion_module_path "${CMAKE_MODULE_PATH}")
set(splitfusion_shared "${BUILD_SHARED_LIBS}")
list(APPEND CMAKE_MODULE_PATH
     "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB")
find_dependency(OpenVDB 10)
set(CMAKE_MODULE_PATH "${splitfusion_module_path}")
set(BUILD_SHARED_LIBS "${splitfusion_shared}")

find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(Ceres 2.1 COMPONENTS SuiteSparse)
find_dependency(OpenCV 4.5 COMPONENTS core imgproc imgcodecs video dnn features2d)
find_dependency(PCL 1.12 COMPONENTS common kdtree sample_consensus)
find_dependency(nlohmann_json 3.11)
find_dependency(SQLite3 3)
find_dependency(ZLIB 1.2)
find_dependency(meshoptimizer)

set(CMAKE_MESSAGE_LOG_LEVEL "${splitfusion_log_level}")
