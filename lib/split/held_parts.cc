#include "splitfusion/lib/split/held_parts.h"

#include <algorithm>
#include <map>
#include <set>

#include "splitfusion/lib/split/surface_contact.h"

namespace splitfusion {
namespace {

/// Share of a part's border that touches what holds it; the noise of what is
/// apart gives none.
constexpr double kMinTouch = 0.05;

/// Nothing is predicted any more where `pixels` are.
void ForgetPrediction(const cv::Mat& pixels, ComparedDepth* compared) {
  compared->labels.setTo(0, pixels);
  compared->agreement.setTo(static_cast<int>(DepthState::kUnmeasured), pixels);
}

/// Index of the detection that holds this one; -1 = none.
int FindHolder(int part, const std::vector<InstanceMask>& detections,
               const std::vector<MergeGroup>& groups, const PointMap& points) {
  int holder = -1;
  double best = kMinTouch;
  for (int i = 0; i < static_cast<int>(detections.size()); ++i) {
    if (i == part || !MayHold(groups, detections[i].class_name,
                              detections[part].class_name)) {
      continue;
    }
    const double share =
        ContactShare(points, detections[part].mask, detections[i].mask);
    if (share < best) continue;
    best = share;
    holder = i;
  }
  return holder;
}

/// The detection at the end of a chain of holders; of a ring, its first.
int WholeOf(int part, const std::vector<int>& holder) {
  std::set<int> seen;
  while (holder[part] >= 0 && seen.insert(part).second) part = holder[part];
  if (holder[part] < 0) return part;
  int first = part;
  for (int i = holder[part]; i != part; i = holder[i])
    first = std::min(first, i);
  return first;
}

}  // namespace

JoinedDetections JoinHeldParts(const std::vector<InstanceMask>& detections,
                               const std::vector<MergeGroup>& groups,
                               const PointMap& points) {
  if (groups.empty()) return {detections, {}};
  const int count = static_cast<int>(detections.size());
  std::vector<int> holder;
  for (int i = 0; i < count; ++i) {
    holder.push_back(FindHolder(i, detections, groups, points));
  }
  JoinedDetections joined;
  std::map<int, std::size_t> place;  // By index of the whole.
  for (int i = 0; i < count; ++i) {
    if (WholeOf(i, holder) != i) continue;
    place[i] = joined.detections.size();
    joined.detections.push_back(detections[i]);
    joined.detections.back().mask = detections[i].mask.clone();
  }
  for (int i = 0; i < count; ++i) {
    const int whole = WholeOf(i, holder);
    if (whole == i) continue;
    joined.detections[place.at(whole)].mask |= detections[i].mask;
    joined.held.push_back(detections[i].mask);
  }
  return joined;
}

void EndHeldTracks(const std::vector<cv::Mat_<uchar>>& held,
                   const std::vector<MergeGroup>& groups, TrackTable* tracks,
                   ComparedDepth* compared) {
  for (auto& [id, track] : *tracks) {
    if (!track.followed() || !MayBeHeld(groups, track.class_name)) continue;
    for (const cv::Mat_<uchar>& mask : held) {
      // The same thing, by an IoU of a half.
      if (ComputeOverlap(mask, id, compared->labels, compared->agreement).iou <
          0.5) {
        continue;
      }
      track.Apply(TrackEvent::kGone);
      ForgetPrediction(compared->labels == id, compared);
    }
  }
}

void TakeOutParts(const std::vector<MergeGroup>& groups,
                  const std::vector<Candidate>& candidates,
                  const TrackTable& tracks, ComparedDepth* compared,
                  std::vector<Match>* matches) {
  for (std::size_t i = 0; i < matches->size(); ++i) {
    Match& match = (*matches)[i];
    for (const auto& [id, track] : tracks) {
      const bool own = match.surface == id && !match.piece;
      if (own || !MayHold(groups, track.class_name, candidates[i].class_name)) {
        continue;
      }
      const cv::Mat surface = compared->labels == id;
      const cv::Mat inside = candidates[i].mask & surface;
      if (2 * cv::countNonZero(inside) > cv::countNonZero(surface)) {
        continue;  // More than a part.
      }
      ForgetPrediction(inside, compared);
      if (match.surface != id) continue;
      match.surface = 0;
      match.piece = false;
    }
  }
}

void TakeOutOthers(const std::vector<Candidate>& candidates,
                   const TrackTable& tracks, ComparedDepth* compared) {
  for (const Candidate& candidate : candidates) {
    const int identity = candidate.appearance.identity;
    for (const auto& [id, track] : tracks) {
      if (identity == 0 || track.appearance.identity == identity) continue;
      ForgetPrediction(candidate.mask & (compared->labels == id), compared);
    }
  }
}

}  // namespace splitfusion
