#ifndef SPLITFUSION_LIB_SPLIT_SURFACE_SPLITTER_H_
#define SPLITFUSION_LIB_SPLIT_SURFACE_SPLITTER_H_

#include <cstdint>
#include <map>
#include <set>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/segmentation/label_table.h"
#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/sequence/frame.h"
#include "splitfusion/lib/split/graph_cut.h"

namespace splitfusion {

/// Surface id of a pixel; 0 is the background.
using LabelImage = cv::Mat_<std::uint16_t>;

/// The surfaces of the frame before, rendered into this frame under their
/// predicted motion. All images are empty in the first frame.
struct SurfacePrediction {
  LabelImage labels;      ///< HxW surface ids, 0 = background or nothing.
  cv::Mat_<float> depth;  ///< HxW z-depth of the rendered surface, metres; 0
                          ///< where nothing was rendered.
};

/// How detections become surfaces; defaults hold for TUM-like sequences.
struct SplitOptions {
  GraphCutOptions graph_cut;
  double min_score = 0.4;       ///< Detections below are ignored.
  double max_area = 0.75;       ///< Fraction of the image; larger is ignored.
  int min_pixels = 600;         ///< With depth; smaller instances are ignored.
  double min_match_iou = 0.2;   ///< Detection to projected surface.
  int max_missed_frames = 15;   ///< Kept alive without a detection.
  int birth_frames = 2;         ///< Detections in as many of the last
                                ///< 2 x birth_frames frames make a surface.
  bool rigid_objects = false;   ///< Give rigid classes surfaces of their own.
  std::set<std::string> classes;  ///< Allow-list; empty = all.

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// A surface the splitter follows.
struct TrackedInstance {
  int id = 0;  ///< From 1, in order of birth, never reused.
  std::string class_name;  ///< Majority of its detections, by score.
  SurfaceKind kind = SurfaceKind::kNonRigid;
  int first_frame = 0;
  int last_detected_frame = 0;
};

/// One decision, for the report.
struct SplitDecision {
  std::string action;  ///< "matched", "born", "missed", "dormant", "revived",
                       ///< "merged", "ignored".
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
  SurfaceSplitter(const PinholeCamera& camera, LabelTable table,
                  SplitOptions options);

  /// Frames must come in order. `detections` as the segmenter gave them.
  SplitResult Split(const Frame& frame, const PointMap& points,
                    const std::vector<InstanceMask>& detections,
                    const SurfacePrediction& prediction);

  /// Every instance ever born, by id.
  const std::map<int, TrackedInstance>& instances() const {
    return instances_;
  }

 private:
  PinholeCamera camera_;
  LabelTable table_;
  SplitOptions options_;
  std::map<int, TrackedInstance> instances_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SURFACE_SPLITTER_H_
