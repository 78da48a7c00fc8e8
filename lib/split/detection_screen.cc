#include "splitfusion/lib/split/detection_screen.h"

#include <map>

namespace splitfusion {
namespace {

Trust TrustOf(const InstanceMask& detection, const LabelTable& table,
              const std::vector<MergeGroup>& groups,
              const SplitOptions& options) {
  const double area =
      double(cv::countNonZero(detection.mask)) / detection.mask.total();
  const bool full = detection.score >= options.min_score &&
                    area <= options.max_area &&
                    (IsTrackable(detection.class_name, table, options) ||
                     MayBeHeld(groups, detection.class_name));
  return full ? Trust::kFull : Trust::kMatched;
}

Segment MakeSegment(const Candidate& candidate, const Match& match,
                    const LabelTable& table, const SplitOptions& options) {
  Segment segment;
  segment.surface = match.surface;
  segment.mask = candidate.mask.clone();
  segment.class_name = candidate.class_name;
  segment.score = candidate.score;
  segment.iou = match.iou;
  segment.only_held =
      !candidate.moved && !IsTrackable(candidate.class_name, table, options);
  return segment;
}

}  // namespace

bool IsTrackable(const std::string& class_name, const LabelTable& table,
                 const SplitOptions& options) {
  return options.rigid_objects == "separate" ||
         table.Kind(class_name) == SurfaceKind::kNonRigid;
}

std::vector<Candidate> ScreenDetections(
    const std::vector<InstanceMask>& detections, const LabelTable& table,
    const std::vector<MergeGroup>& groups, const SplitOptions& options) {
  std::vector<Candidate> candidates;
  for (const InstanceMask& detection : detections) {
    candidates.push_back({detection.mask,
                          TrustOf(detection, table, groups, options),
                          detection.class_name, detection.score});
  }
  return candidates;
}

SortedDetections SortDetections(const std::vector<Candidate>& candidates,
                                const std::vector<Match>& matches,
                                const LabelTable& table,
                                const SplitOptions& options, cv::Size size) {
  SortedDetections sorted;
  sorted.unconfirmed = cv::Mat_<uchar>(size, uchar(0));
  std::map<int, std::size_t> segment_of;  // By surface.
  const auto add = [&](const Candidate& candidate, const Match& match) {
    const Segment segment = MakeSegment(candidate, match, table, options);
    const auto known = segment_of.find(match.surface);
    if (match.surface == 0 && candidate.trust != Trust::kFull) {
      sorted.decisions.push_back(
          MakeDecision(candidate.moved ? "pending" : "ignored", segment));
      const bool weak = candidate.score < options.min_score &&
                        IsTrackable(candidate.class_name, table, options);
      if (weak || candidate.moved) sorted.unconfirmed |= candidate.mask;
    } else if (match.surface > 0 && known != segment_of.end()) {
      sorted.segments[known->second].mask |= candidate.mask;
      sorted.decisions.push_back(MakeDecision("merged", segment));
    } else {
      segment_of[match.surface] = sorted.segments.size();
      sorted.segments.push_back(segment);
    }
  };
  // Pieces last, so that a segment begins with its main detection.
  for (const bool piece : {false, true}) {
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if (matches[i].piece == piece) add(candidates[i], matches[i]);
    }
  }
  return sorted;
}

}  // namespace splitfusion
