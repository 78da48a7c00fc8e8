#ifndef SPLITFUSION_LIB_REPORT_LIBRARY_VERSIONS_H_
#define SPLITFUSION_LIB_REPORT_LIBRARY_VERSIONS_H_

#include <map>
#include <string>

namespace splitfusion {

/// Versions of the libraries that decide the result, by name: Ceres, Eigen,
/// OpenCV, OpenVDB, TBB, and the compiler.
std::map<std::string, std::string> LibraryVersions();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_LIBRARY_VERSIONS_H_
