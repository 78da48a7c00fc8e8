#include "splitfusion/lib/report/refinement_report.h"

#include <nlohmann/json.hpp>

#include "splitfusion/lib/base/json_file.h"

namespace splitfusion {
namespace {

nlohmann::ordered_json CostJson(const HiddenMotionCost& cost) {
  return {{"arap", cost.arap}, {"smoothness", cost.smoothness}};
}

}  // namespace

std::string RefinementLines(int surface,
                            const std::vector<RefinedWindow>& windows) {
  std::string lines;
  for (const RefinedWindow& window : windows) {
    const nlohmann::ordered_json line = {
        {"surface", surface},
        {"part", window.part},
        {"first_frame", window.first_frame},
        {"last_frame", window.last_frame},
        {"hidden", window.hidden},
        {"iterations", window.iterations},
        {"solved", window.solved},
        {"initial", CostJson(window.initial)},
        {"final", CostJson(window.final)},
        {"seconds", window.seconds}};
    lines += JsonText(line) + "\n";
  }
  return lines;
}

}  // namespace splitfusion
