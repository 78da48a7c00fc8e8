#ifndef SPLITFUSION_LIB_SPLIT_INSTANCE_MATCHER_H_
#define SPLITFUSION_LIB_SPLIT_INSTANCE_MATCHER_H_

#include <opencv2/core.hpp>
#include <set>
#include <string>
#include <vector>

#include "splitfusion/lib/split/surface_prediction.h"

namespace splitfusion {

/// How far a detection may be trusted.
enum class Trust {
  kFull,     ///< May found a surface.
  kMatched,  ///< Counts only if it covers a known surface well: low score,
             ///< rigid class or very large.
};

/// One detection as the matcher sees it.
struct Candidate {
  cv::Mat_<uchar> mask;         ///< HxW, 255 inside.
  Trust trust = Trust::kFull;   ///< How far it may be trusted.
  std::string class_name = "";  ///< As the detector gave it.
  double score = 1;             ///< 0..1.
  bool moved = false;           ///< Of a rigid class, but seems to have moved.
};

/// How detections are matched to projected surfaces.
struct MatchOptions {
  double min_iou = 0.2;          ///< Detection to projected surface.
  double min_iou_matched = 0.5;  ///< For detections of Trust::kMatched.
  double min_contained = 0.6;    ///< Of a piece in its surface, or of a surface
                                 ///< in the detection that outgrew it.
  double min_agreement = 0.3;    ///< Of live with predicted depth.

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// Which surface a detection belongs to.
struct Match {
  int surface = 0;     ///< Id, 0 if none.
  double iou = 0;      ///< With the projected surface.
  bool piece = false;  ///< A further detection on a surface that has one.
};

/// Matches detections to projected surfaces: one to one by largest IoU first;
/// what is left and lies inside of a surface, at its depth, is a piece of it.
/// The class does not count: detectors change their mind about it.
///
/// `agreement`: HxW 8UC1, a DepthState; `surfaces`: ids that may be matched.
std::vector<Match> MatchInstances(const std::vector<Candidate>& candidates,
                                  const LabelImage& predicted_labels,
                                  const cv::Mat_<uchar>& agreement,
                                  const std::set<int>& surfaces,
                                  const MatchOptions& options);

/// How a detection and a projected surface cover each other.
struct Overlap {
  double iou = 0;        ///< Intersection over union.
  double contained = 0;  ///< Share of the detection inside of the surface, at
                         ///< its depth.
  double covered = 0;    ///< Share of the surface inside of the detection.
  double agreement = 0;  ///< Share of the common pixels with depth that lie at
                         ///< the surface's depth.
};

/// Overlap of a mask with one projected surface.
Overlap ComputeOverlap(const cv::Mat_<uchar>& mask, int surface,
                       const LabelImage& predicted_labels,
                       const cv::Mat_<uchar>& agreement);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_INSTANCE_MATCHER_H_
