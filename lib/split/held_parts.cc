#include "splitfusion/lib/split/held_parts.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>

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

/// Pixels of a surface, which may lie in several segments.
cv::Mat_<uchar> SurfacePixels(int surface, const SplitWork& work) {
  cv::Mat_<uchar> pixels(work.segment_labels.size(), uchar(0));
  for (int i = 0; i < static_cast<int>(work.segments.size()); ++i) {
    if (work.segments[i].surface != surface) continue;
    pixels |= SegmentPixels(i, work.segment_labels);
  }
  return pixels;
}

/// Pixels of a surface and of all that is held with it.
cv::Mat_<uchar> WholePixels(int whole, const InstanceRegistry& registry,
                            const LabelImage& labels) {
  cv::Mat_<uchar> pixels(labels.size(), uchar(0));
  for (const auto& [id, instance] : registry.instances()) {
    if (registry.Whole(id) == whole) pixels |= labels == id;
  }
  return pixels;
}

/// Pixels of whatever held a part last, of what held that last, and so on.
cv::Mat_<uchar> HolderPixels(int part, const InstanceRegistry& registry,
                             const LabelImage& labels) {
  cv::Mat_<uchar> pixels(labels.size(), uchar(0));
  std::set<int> seen = {part};
  int body = registry.LastHolder(part);
  while (body > 0 && seen.insert(body).second) {
    pixels |= labels == body;
    body = registry.LastHolder(body);
  }
  return pixels;
}

/// Whether a surface may hold the part of this segment, if the two touch.
bool MayHoldSegment(int body, const Segment& part,
                    const std::vector<MergeGroup>& groups,
                    const InstanceRegistry& registry) {
  // Nothing holds what it is held by.
  if (registry.at(body).dormant || registry.Whole(body) == part.surface) {
    return false;
  }
  const std::string& part_class =
      part.surface > 0 ? registry.at(part.surface).class_name : part.class_name;
  return MayHold(groups, registry.at(body).class_name, part_class);
}

/// Surfaces of this frame; each once.
std::set<int> SurfacesOf(const SplitWork& work) {
  std::set<int> surfaces;
  for (const Segment& segment : work.segments) surfaces.insert(segment.surface);
  surfaces.erase(0);
  return surfaces;
}

/// Index of the first segment of a surface, with its main detection.
int FirstSegment(int surface, const SplitWork& work) {
  int index = 0;
  while (work.segments[index].surface != surface) ++index;
  return index;
}

bool IsDetected(int surface, const SplitWork& work) {
  return std::any_of(
      work.segments.begin(), work.segments.end(), [&](const Segment& segment) {
        return segment.surface == surface && !segment.mask.empty();
      });
}

/// Holds, keeps or releases a surface.
void SettlePart(int part, const std::vector<MergeGroup>& groups,
                InstanceRegistry* registry, SplitWork* work) {
  const int index = FirstSegment(part, *work);
  const int holder = registry->at(part).held_by;
  if (registry->at(part).dormant ||
      (holder > 0 && registry->at(holder).dormant)) {
    registry->Release(part);
  }
  if (IsDetected(part, *work)) {
    const int held_by = registry->at(part).held_by;
    const int touched = FindHolder(index, groups, *registry, *work);
    if (held_by > 0 && touched != held_by &&
        registry->CountApart(part) >= kApartFrames) {
      registry->Release(part);
    }
    if (touched > 0 &&
        (touched == held_by || registry->at(part).held_by == 0)) {
      registry->Hold(part, touched);
    }
  }
  if (registry->at(part).held_by == 0) return;
  SplitDecision decision = MakeDecision("merged", work->segments[index]);
  decision.surface = registry->Whole(part);
  work->result.decisions.push_back(decision);
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
    work->compared.agreement.setTo(static_cast<int>(DepthState::kUnmeasured),
                                   inside);
    match = {};
  }
}

void SplitHeldParts(const InstanceRegistry& registry, const LabelImage& last,
                    LabelImage* predicted) {
  if (last.empty()) return;
  for (const int part : registry.Followed()) {
    if (registry.LastHolder(part) == 0) continue;
    cv::Point2d shift(0, 0);
    if (registry.at(part).held_by > 0) {
      const int whole = registry.Whole(part);
      shift = CenterOf(WholePixels(whole, registry, *predicted)) -
              CenterOf(WholePixels(whole, registry, last));
    }
    const cv::Mat_<uchar> was = last == part;
    predicted->setTo(
        part, Shifted(was, shift) & HolderPixels(part, registry, *predicted));
  }
}

int FindHolder(int index, const std::vector<MergeGroup>& groups,
               const InstanceRegistry& registry, const SplitWork& work) {
  const Segment& part = work.segments[index];
  const int holder = part.surface > 0 ? registry.at(part.surface).held_by : 0;
  const cv::Mat_<uchar> pixels =
      part.surface > 0 ? SurfacePixels(part.surface, work)
                       : SegmentPixels(index, work.segment_labels);
  int best = 0;
  double best_share = 0;
  for (const int body : SurfacesOf(work)) {
    if (!MayHoldSegment(body, part, groups, registry)) continue;
    const double share =
        ContactShare(work.points, pixels, SurfacePixels(body, work));
    if (share < kMinTouch) continue;
    if (body == holder) return holder;
    if (share <= best_share) continue;
    best = body;
    best_share = share;
  }
  return best;
}

void HoldTouchingParts(const std::vector<MergeGroup>& groups,
                       InstanceRegistry* registry, SplitWork* work) {
  if (groups.empty()) return;
  for (const int id : SurfacesOf(*work)) SettlePart(id, groups, registry, work);
}

LabelImage JoinHeldParts(const InstanceRegistry& registry,
                         const LabelImage& labels) {
  LabelImage joined = labels.clone();
  for (const auto& [id, instance] : registry.instances()) {
    if (instance.held_by > 0) joined.setTo(registry.Whole(id), labels == id);
  }
  return joined;
}

}  // namespace splitfusion
