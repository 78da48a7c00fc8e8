#include "splitfusion/lib/report/library_versions.h"

#include <ceres/version.h>
#include <openvdb/version.h>
#include <tbb/version.h>

#include <Eigen/Core>
#include <opencv2/core/version.hpp>

namespace splitfusion {

std::map<std::string, std::string> LibraryVersions() {
  const auto dotted = [](int a, int b, int c) {
    return std::to_string(a) + "." + std::to_string(b) + "." +
           std::to_string(c);
  };
  return {{"ceres", CERES_VERSION_STRING},
          {"compiler", __VERSION__},
          {"eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                           EIGEN_MINOR_VERSION)},
          {"opencv", CV_VERSION},
          {"openvdb", OPENVDB_LIBRARY_VERSION_STRING},
          {"tbb", TBB_VERSION_STRING}};
}

}  // namespace splitfusion
