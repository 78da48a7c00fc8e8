#ifndef SPLITFUSION_LIB_REPORT_REPORT_JSON_H_
#define SPLITFUSION_LIB_REPORT_REPORT_JSON_H_

#include <nlohmann/json_fwd.hpp>

#include "splitfusion/lib/report/frame_report.h"

namespace splitfusion {

/// One line of `frames.jsonl`; keys and units in docs/report_format.md. The
/// solver's iterations appear as their number (`iterations.csv` has them).
nlohmann::ordered_json ToJson(const FrameReport& report);

/// The object `hold` of `frames.jsonl` and `summary.json`.
void to_json(nlohmann::ordered_json& json, const HoldReport& hold);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_REPORT_JSON_H_
