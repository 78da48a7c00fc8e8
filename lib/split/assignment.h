#ifndef SPLITFUSION_LIB_SPLIT_ASSIGNMENT_H_
#define SPLITFUSION_LIB_SPLIT_ASSIGNMENT_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/split/assignment_options.h"
#include "splitfusion/lib/split/surface_prediction.h"
#include "splitfusion/lib/split/tentative_tracks.h"
#include "splitfusion/lib/split/track_table.h"

namespace splitfusion {

/// One detection, and what is known of it.
struct Candidate {
  cv::Mat_<uchar> mask;                       ///< HxW, 255 inside.
  std::string class_name = "";                ///< As the detector gave it.
  double score = 1;                           ///< 0..1.
  SurfaceKind kind = SurfaceKind::kNonRigid;  ///< Of its class.
  /// May become a surface; else (low score, rigid class, very large) it counts
  /// only if it is clearly of a known one.
  bool trusted = true;
  bool moved = false;  ///< Of a rigid class, but stands where space was empty.
  Appearance appearance;  ///< Of its pixels.
  /// Of a rigid class, and most of it is not where background was mapped: may
  /// be a known surface of such a class.
  bool apart = false;
};

/// What a detection is of.
struct Match {
  int surface = 0;     ///< Id; 0 = none.
  int tentative = -1;  ///< Index of a tentative track; -1 = none.
  double iou = 0;      ///< With the projected surface.
  bool piece = false;  ///< A further detection on a surface that has one.
};

/// How a detection and a projected surface cover each other.
struct Overlap {
  /// Intersection over union of what nothing nearer occludes; what lies at
  /// another depth is not common.
  double iou = 0;
  /// Share of the detection inside of the surface, at its depth.
  double contained = 0;
};

/// Overlap of a mask with one projected surface. `agreement`: HxW 8UC1, a
/// DepthState.
Overlap ComputeOverlap(const cv::Mat_<uchar>& mask, int surface,
                       const LabelImage& predicted_labels,
                       const cv::Mat_<uchar>& agreement);

/// What detections are compared with.
struct KnownSurfaces {
  const TrackTable& tracks;                      ///< All ever born.
  const std::vector<TentativeTrack>& tentative;  ///< May become surfaces.
  const LabelImage& predicted_labels;            ///< HxW, projected surfaces.
  const cv::Mat_<uchar>& agreement;              ///< HxW, a DepthState.
  int frame;                                     ///< Index.
};

/// Assigns every detection to at most one track and every track to at most one
/// detection, so that the sum of the log-likelihood ratios of overlap, colour
/// and place ("of the same surface" against "of another one") is greatest.
/// Inactive and occluded tracks take part: where nothing of one is projected,
/// colour and place decide. What is left and lies inside of a surface, at its
/// depth, is a piece of it. The class does not count: detectors change their
/// mind about it. Of one that is not trusted, overlap alone counts, unless it
/// is apart and the surface rigid. Where identities are given these alone
/// decide.
std::vector<Match> AssignDetections(const std::vector<Candidate>& candidates,
                                    const KnownSurfaces& known,
                                    const AssignmentOptions& options);

/// The surface that a new one turns out to be, as more of it comes into view:
/// one that is not tracked and was last detected before the birth of `track`,
/// is alike in colour and place, and of which more was seen. 0 if none.
int FindReturned(const Track& track, const TrackTable& tracks, int frame,
                 const AssignmentOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_ASSIGNMENT_H_
