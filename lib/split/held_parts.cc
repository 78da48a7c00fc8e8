#include "splitfusion/lib/split/held_parts.h"

#include <cstdint>

#include "splitfusion/lib/split/image_motion.h"
#include "splitfusion/lib/split/surface_contact.h"

namespace splitfusion {
namespace {

/// Share of a part's border that touches what holds it; the noise of what is
/// apart gives none.
constexpr double kMinTouch = 0.05;

/// Frames without contact after which a part is on its own.
constexpr int kApartFrames = 5;

/// A detection that covers more of a surface is the surface itself.
constexpr double kMaxCovered = 0.5;

/// Share of the border of a segment that touches a followed surface which may
/// hold it; 0 if it may not.
double TouchShare(int part_index, int body_index,
                  const std::vector<MergeGroup>& groups,
                  const InstanceRegistry& registry, const SplitWork& work) {
  const Segment& part = work.segments[part_index];
  const int body = work.segments[body_index].surface;
  if (body == 0 || body == part.surface) return 0;
  if (registry.at(body).dormant || registry.at(body).held_by > 0) return 0;
  const std::string& part_class =
      part.surface > 0 ? registry.at(part.surface).class_name : part.class_name;
  if (!MayHold(groups, registry.at(body).class_name, part_class)) return 0;
  return ContactShare(work.points,
                      SegmentPixels(part_index, work.segment_labels),
                      SegmentPixels(body_index, work.segment_labels));
}

/// Holds, keeps or releases the surface of one segment.
void SettlePart(int index, const std::vector<MergeGroup>& groups,
                InstanceRegistry* registry, SplitWork* work) {
  const Segment& segment = work->segments[index];
  const int part = segment.surface;
  const int held_by = registry->at(part).held_by;
  const bool seen = !segment.mask.empty();
  const int touched = seen ? FindHolder(index, groups, *registry, *work) : 0;
  if (registry->at(part).dormant ||
      (held_by > 0 && registry->at(held_by).dormant)) {
    registry->Release(part);
  }
  if (touched > 0) {
    registry->Hold(part, touched);
  } else if (seen && held_by > 0 &&
             registry->CountApart(part) >= kApartFrames) {
    registry->Release(part);
  }
  SplitDecision decision = MakeDecision("merged", segment);
  decision.surface = registry->at(part).held_by;
  if (decision.surface > 0) work->result.decisions.push_back(decision);
}

}  // namespace

void TakeOutParts(const std::vector<MergeGroup>& groups,
                  const std::vector<Candidate>& candidates,
                  const InstanceRegistry& registry, SplitWork* work,
                  std::vector<Match>* matches) {
  for (std::size_t i = 0; i < matches->size(); ++i) {
    Match& match = (*matches)[i];
    if (!match.piece || !MayHold(groups, registry.at(match.surface).class_name,
                                 candidates[i].class_name)) {
      continue;
    }
    const cv::Mat_<uchar>& mask = candidates[i].mask;
    const Overlap overlap = ComputeOverlap(
        mask, match.surface, work->prior.labels, work->compared.agreement);
    if (overlap.covered > kMaxCovered) continue;
    const cv::Mat inside = mask & (work->prior.labels == match.surface);
    work->prior.labels.setTo(0, inside);
    work->compared.labels.setTo(0, inside);
    work->compared.agreement.setTo(static_cast<int>(Agreement::kUnknown),
                                   inside);
    match = {};
  }
}

void SplitHeldParts(const InstanceRegistry& registry, const LabelImage& last,
                    LabelImage* predicted) {
  if (last.empty()) return;
  for (const int part : registry.Followed()) {
    const int body = registry.LastHolder(part);
    if (body == 0) continue;
    cv::Point2d shift(0, 0);
    if (registry.at(part).held_by == body) {
      shift = CenterOf((*predicted == body) | (*predicted == part)) -
              CenterOf((last == body) | (last == part));
    }
    const cv::Mat_<uchar> was = last == part;
    predicted->setTo(part, Shifted(was, shift) & (*predicted == body));
  }
}

int FindHolder(int index, const std::vector<MergeGroup>& groups,
               const InstanceRegistry& registry, const SplitWork& work) {
  const int part = work.segments[index].surface;
  const int holder = part > 0 ? registry.at(part).held_by : 0;
  int best = 0;
  double best_share = kMinTouch;
  for (int i = 0; i < static_cast<int>(work.segments.size()); ++i) {
    const double share = TouchShare(index, i, groups, registry, work);
    if (share < best_share) continue;
    best = work.segments[i].surface;
    if (best == holder) return holder;
    best_share = share;
  }
  return best;
}

void HoldTouchingParts(const std::vector<MergeGroup>& groups,
                       InstanceRegistry* registry, SplitWork* work) {
  if (groups.empty()) return;
  for (int i = 0; i < static_cast<int>(work->segments.size()); ++i) {
    const int id = work->segments[i].surface;
    if (id > 0 && registry->at(id).merged_into == 0) {
      SettlePart(i, groups, registry, work);
    }
  }
}

LabelImage JoinHeldParts(const InstanceRegistry& registry,
                         const LabelImage& labels) {
  LabelImage joined = labels.clone();
  for (const auto& [id, instance] : registry.instances()) {
    if (instance.held_by > 0) joined.setTo(instance.held_by, labels == id);
  }
  return joined;
}

}  // namespace splitfusion
