#include "splitfusion/lib/report/refinement_report.h"

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/json_file.h"

namespace splitfusion {

void RefinementReport::Add(int surface,
                           const std::vector<RefinedWindow>& refined,
                           const std::vector<HiddenDeviation>& sampled) {
  for (const RefinedWindow& window : refined) {
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
    windows += JsonText(line) + "\n";
  }
  for (const HiddenDeviation& one : sampled) {
    deviations +=
        cv::format("%d,%d,%d,%.5f\n", surface, one.frame, one.node, one.sigma);
  }
}

void RefinementReport::Write(const RunPaths& paths) const {
  WriteFileAtomically(paths.Refinement(),
                      [this](std::ostream& out) { out << windows; });
  if (deviations.empty()) return;
  WriteFileAtomically(paths.HiddenDeviations(), [this](std::ostream& out) {
    out << "surface,frame,node,sigma\n" << deviations;
  });
}

}  // namespace splitfusion
