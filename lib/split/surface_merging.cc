#include "splitfusion/lib/split/surface_merging.h"

#include "splitfusion/lib/split/instance_matcher.h"
#include "splitfusion/lib/split/surface_contact.h"

namespace splitfusion {
namespace {

/// Frames in which a detection covers a second surface before the two are
/// taken for one.
constexpr int kCoveredFrames = 3;

/// Whether the detection of one segment covers the undetected surface of
/// another, `part`, of the same class, and touches it.
bool IsCovered(const Segment& part, int body_index,
               const InstanceRegistry& registry, double min_contact,
               const SplitWork& work) {
  const Segment& body = work.segments[body_index];
  if (body.mask.empty() || body.surface == 0 ||
      registry.at(body.surface).class_name != part.class_name) {
    return false;
  }
  const Overlap overlap = ComputeOverlap(
      body.mask, part.surface, work.prior.labels, work.compared.agreement);
  const MatchOptions limits;
  if (overlap.covered * overlap.agreement < limits.min_contained) return false;
  const cv::Mat_<uchar> seen =
      AgreeingPixels(part.surface, work.prior.labels, work.compared.agreement);
  return ContactShare(work.points, seen,
                      SegmentPixels(body_index, work.segment_labels)) >=
         min_contact;
}

}  // namespace

int FindBody(int index, const InstanceRegistry& registry, double min_contact,
             const SplitWork& work) {
  const cv::Mat_<uchar> pixels = SegmentPixels(index, work.segment_labels);
  int best = 0;
  double best_share = min_contact;
  for (int i = 0; i < static_cast<int>(work.segments.size()); ++i) {
    const int id = work.segments[i].surface;
    const bool alike =
        i != index && id > 0 &&
        registry.at(id).class_name == work.segments[index].class_name;
    if (!alike) continue;
    const double share = ContactShare(work.points, pixels,
                                      SegmentPixels(i, work.segment_labels));
    if (share < best_share) continue;
    best_share = share;
    best = id;
  }
  return best;
}

void MergeCoveredSurfaces(double min_contact, InstanceRegistry* registry,
                          SplitWork* work) {
  for (Segment& part : work->segments) {
    if (part.surface == 0 || !part.mask.empty()) continue;
    for (std::size_t i = 0; i < work->segments.size(); ++i) {
      const Segment& body = work->segments[i];
      if (!IsCovered(part, static_cast<int>(i), *registry, min_contact,
                     *work)) {
        continue;
      }
      const int hits = registry->CountCovered(part.surface, body.surface);
      if (hits < kCoveredFrames) continue;
      registry->Merge(part.surface, body.surface);
      work->result.decisions.push_back(MakeDecision("merged", part));
      part.surface = body.surface;
      break;
    }
  }
}

}  // namespace splitfusion
