#ifndef SPLITFUSION_LIB_SPLIT_SURFACE_SPLITTER_H_
#define SPLITFUSION_LIB_SPLIT_SURFACE_SPLITTER_H_

#include <map>
#include <opencv2/core.hpp>
#include <set>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/segmentation/label_table.h"
#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/sequence/frame.h"
#include "splitfusion/lib/split/birth_queue.h"
#include "splitfusion/lib/split/graph_cut.h"
#include "splitfusion/lib/split/instance_matcher.h"
#include "splitfusion/lib/split/instance_registry.h"
#include "splitfusion/lib/split/mask_support.h"
#include "splitfusion/lib/split/segment.h"
#include "splitfusion/lib/split/surface_prediction.h"
#include "splitfusion/lib/split/surface_prior.h"
#include "splitfusion/lib/split/uncertain_region.h"

namespace splitfusion {

/// How detections become surfaces; defaults hold for TUM-like sequences.
struct SplitOptions {
  GraphCutOptions graph_cut;
  PriorOptions prior;
  UncertainOptions uncertain;
  double min_score = 0.4;        ///< A detection below counts only if it covers
                                 ///< a known surface well.
  double max_area = 0.75;        ///< Fraction of the image; larger likewise.
  int min_pixels = 600;          ///< With depth; smaller instances are ignored.
  double min_match_iou = 0.2;    ///< Detection to projected surface.
  int max_missed_frames = 15;    ///< Kept alive without a detection.
  int birth_frames = 2;          ///< Detections in as many of the last
                                 ///< 2 x birth_frames frames make a surface;
                                 ///< twice as many if it stands where
                                 ///< background was mapped.
  double confident_score = 0.5;  ///< A detection of the first frame makes a
                                 ///< surface at once from this score on.
  /// A newcomer is a part of the surface that it touches along this share of
  /// its border.
  double min_contact = 0.12;
  bool rigid_objects = false;     ///< Give rigid classes surfaces of their own.
  std::set<std::string> classes;  ///< Allow-list; empty = all.

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// One decision, for the report.
struct SplitDecision {
  std::string action;  ///< "matched", "born", "missed", "dormant", "revived",
                       ///< "merged", "pending", "ignored".
  int surface = 0;     ///< Surface id, 0 if none.
  std::string class_name;
  double score = 0;    ///< Of the detection; 0 if none.
  double overlap = 0;  ///< IoU with the projected surface; 0 if none.
};

/// Result of one frame.
struct SplitResult {
  LabelImage labels;  ///< HxW: surface id of every pixel, 0 = background.
  /// HxW 8UC1: 255 where the pixel may be background but is too close to a
  /// foreign or unexplained instance to be tracked or fused as such.
  cv::Mat uncertain;
  std::vector<SplitDecision> decisions;
};

/// Splits a frame into surfaces that keep their ids over time (SplitFusion
/// IV-A): matches the detections to the projected surfaces of the frame
/// before, refines their masks by a 3D graph cut, and carries surfaces through
/// missed detections with the projected surface as prior.
class SurfaceSplitter {
 public:
  /// @throw InputError if the camera or an option is out of its range.
  SurfaceSplitter(const PinholeCamera& camera, LabelTable table,
                  SplitOptions options);

  /// Frames must come in order. `detections` as the segmenter gave them. Where
  /// the prediction is empty, or lacks a surface, the labels and the depth of
  /// the frame before stand in for it.
  ///
  /// @throw InputError if an image does not have the camera's size.
  SplitResult Split(const Frame& frame, const PointMap& points,
                    const std::vector<InstanceMask>& detections,
                    const SurfacePrediction& prediction);

  /// Every instance ever born, by id.
  const std::map<int, TrackedInstance>& instances() const {
    return registry_.instances();
  }

 private:
  /// What one call of Split() works on.
  struct Work {
    const Frame& frame;
    const PointMap& points;
    SurfacePrediction prior;
    cv::Mat_<uchar> agreement;
    std::vector<Segment> segments;
    LabelImage segment_labels;    // 1 + index of the segment.
    cv::Mat_<uchar> unconfirmed;  // Detections that are no surface.
    SplitResult result;
  };

  void CheckSizes(const Frame& frame,
                  const std::vector<InstanceMask>& detections,
                  const SurfacePrediction& prediction) const;
  SurfacePrediction ComposePrior(const SurfacePrediction& prediction) const;
  bool IsTrackable(const std::string& class_name) const;
  Trust TrustOf(const InstanceMask& detection) const;
  void CollectSegments(const std::vector<InstanceMask>& detections,
                       Work* work) const;
  void AddMissedSurfaces(Work* work) const;
  void CutSegments(Work* work) const;
  void RecordSurface(const Segment& segment, Work* work);
  void RecordMissed(const Segment& segment, int pixels, Work* work);
  void SettleNewcomer(int index, Work* work);
  int FindBody(int index, const cv::Mat_<uchar>& pixels,
               const Work& work) const;
  bool IsConfirmed(const Segment& segment, const cv::Mat_<uchar>& pixels,
                   const Work& work);
  void MergeCoveredSurfaces(Work* work);
  void FinishLabels(Work* work) const;

  PinholeCamera camera_;
  LabelTable table_;
  SplitOptions options_;
  InstanceRegistry registry_;
  BirthQueue births_;
  MaskSupport support_;
  int frames_ = 0;  // Split so far, the current one included.
  SurfacePrediction last_;  // Labels and live depth of the frame before.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SURFACE_SPLITTER_H_
