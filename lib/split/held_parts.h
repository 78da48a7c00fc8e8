#ifndef SPLITFUSION_LIB_SPLIT_HELD_PARTS_H_
#define SPLITFUSION_LIB_SPLIT_HELD_PARTS_H_

#include <vector>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/split/assignment.h"
#include "splitfusion/lib/split/merge_groups.h"
#include "splitfusion/lib/split/surface_prior.h"

namespace splitfusion {

/// Detections in which what somebody holds is a part of who holds it.
struct JoinedDetections {
  std::vector<InstanceMask> detections;  ///< What is held is in its holder's.
  std::vector<cv::Mat_<uchar>> held;     ///< Masks that were joined to another.
};

/// Joins what is held, before anything is split: a detection of a class that
/// may be held, see MergeGroup, and that touches one that may hold it joins
/// that one's mask; of several the one that it touches along most of its
/// border. What holds a part may be held itself. Apart, both are what they are.
JoinedDetections JoinHeldParts(const std::vector<InstanceMask>& detections,
                               const std::vector<MergeGroup>& groups,
                               const PointMap& points);

/// Ends the tracks of what is held now: those that a held mask covers become
/// inactive, and nothing is predicted of them. They may be revived.
void EndHeldTracks(const std::vector<cv::Mat_<uchar>>& held,
                   const std::vector<MergeGroup>& groups, TrackTable* tracks,
                   ComparedDepth* compared);

/// Takes what was put down out of the surfaces whose models still have it: a
/// candidate that such a surface may hold, but that was not joined to it, is no
/// piece of it, and inside of its mask the prediction is no longer that of the
/// surface. One that covers most of the surface is the same thing under another
/// class.
void TakeOutParts(const std::vector<MergeGroup>& groups,
                  const std::vector<Candidate>& candidates,
                  const TrackTable& tracks, ComparedDepth* compared,
                  std::vector<Match>* matches);

/// Where a mask is known to be of another one, see InstanceMask::identity,
/// nothing is predicted of a surface.
void TakeOutOthers(const std::vector<Candidate>& candidates,
                   const TrackTable& tracks, ComparedDepth* compared);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_HELD_PARTS_H_
