#include "splitfusion/lib/report/refinement_report.h"

#include <nlohmann/json.hpp>

#include "splitfusion/lib/base/json_file.h"

namespace splitfusion {

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
        {"kept", window.kept},
        {"iterations", window.iterations},
        {"solved", window.solved},
        {"initial_arap", window.initial.arap},
        {"initial_smoothness", window.initial.smoothness},
        {"final_arap", window.final.arap},
        {"final_smoothness", window.final.smoothness}};
    lines += JsonText(line) + "\n";
  }
  return lines;
}

}  // namespace splitfusion
