#ifndef SPLITFUSION_LIB_REPORT_REPORT_JSON_H_
#define SPLITFUSION_LIB_REPORT_REPORT_JSON_H_

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "splitfusion/lib/report/frame_report.h"

namespace splitfusion {

/// One line of `frames.jsonl`; keys and units in docs/report_format.md. The
/// solver's iterations appear as their number (`iterations.csv` has them).
nlohmann::ordered_json ToJson(const FrameReport& report);

/// Text of a JSON value. NaN and infinity become null, invalid UTF-8 becomes
/// the replacement character. `indent` < 0 gives one line.
std::string JsonText(const nlohmann::ordered_json& value, int indent = -1);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_REPORT_JSON_H_
