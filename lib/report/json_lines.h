#ifndef SPLITFUSION_LIB_REPORT_JSON_LINES_H_
#define SPLITFUSION_LIB_REPORT_JSON_LINES_H_

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace splitfusion {

/// Reads a file of one JSON object per line. A last line without its end (the
/// writer was cut off) is left out.
///
/// @throw InputError on a missing file or a line that is not an object; names
///     file and line.
std::vector<nlohmann::ordered_json> ReadJsonLines(const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_JSON_LINES_H_
