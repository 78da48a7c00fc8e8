#include "splitfusion/lib/split/hidden_instances.h"

#include <set>

namespace splitfusion {
namespace {

/// A surface is hidden if it is seen, as predicted, at fewer pixels than this
/// share of the detection's.
constexpr double kMaxSeen = 0.5;

std::set<int> HiddenBehind(const Candidate& candidate,
                           const std::set<int>& unmatched,
                           const SplitWork& work) {
  const double limit = kMaxSeen * cv::countNonZero(candidate.mask);
  std::set<int> hidden;
  for (const int id : unmatched) {
    const cv::Mat_<uchar> seen =
        AgreeingPixels(id, work.compared.labels, work.compared.agreement);
    if (cv::countNonZero(seen) < limit) hidden.insert(id);
  }
  return hidden;
}

}  // namespace

void RecognizeHidden(const std::vector<Candidate>& candidates,
                     const LabelTable& table, const InstanceRegistry& registry,
                     const SplitWork& work, std::vector<Match>* matches) {
  std::set<int> unmatched = registry.Followed();
  for (const Match& match : *matches) unmatched.erase(match.surface);
  for (std::size_t i = 0; i < candidates.size() && !unmatched.empty(); ++i) {
    const Candidate& candidate = candidates[i];
    Match& match = (*matches)[i];
    if (match.surface != 0 || candidate.trust != Trust::kFull) continue;
    const std::set<int> hidden = HiddenBehind(candidate, unmatched, work);
    if (hidden.empty()) continue;
    match.surface = registry.FindAlike(
        ComputeAppearance(work.frame.color, work.points, candidate.mask),
        table.Kind(candidate.class_name), hidden, work.frame.index);
    unmatched.erase(match.surface);
  }
}

}  // namespace splitfusion
