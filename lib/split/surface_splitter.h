#ifndef SPLITFUSION_LIB_SPLIT_SURFACE_SPLITTER_H_
#define SPLITFUSION_LIB_SPLIT_SURFACE_SPLITTER_H_

#include <map>
#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/segmentation/label_table.h"
#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/sequence/frame.h"
#include "splitfusion/lib/split/birth_queue.h"
#include "splitfusion/lib/split/instance_registry.h"
#include "splitfusion/lib/split/mask_support.h"
#include "splitfusion/lib/split/moving_objects.h"
#include "splitfusion/lib/split/segment.h"
#include "splitfusion/lib/split/split_options.h"
#include "splitfusion/lib/split/split_result.h"
#include "splitfusion/lib/split/split_work.h"
#include "splitfusion/lib/split/surface_prediction.h"

namespace splitfusion {

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

  /// Saves or restores all that later frames depend on, see
  /// lib/base/archive.h; of a splitter with the same camera and options.
  template <typename Archive>
  void Serialize(Archive* archive) {
    archive->Section("splitter");
    (*archive)(registry_, births_, objects_, support_, last_, frames_);
  }

 private:
  void CheckSizes(const Frame& frame,
                  const std::vector<InstanceMask>& detections,
                  const SurfacePrediction& prediction) const;
  void CollectSegments(const std::vector<InstanceMask>& detections,
                       SplitWork* work);
  cv::Mat_<uchar> WatchObjects(const SplitWork& work,
                               std::vector<Candidate>* candidates);
  void AddMissedSurfaces(SplitWork* work) const;
  void CutSegments(SplitWork* work) const;
  SurfaceObservation Observe(int index, const SplitWork& work) const;
  void SettleSurfaces(SplitWork* work);
  void SettleMissed(const Segment& segment, int pixels, SplitWork* work);
  void SettleNewcomers(SplitWork* work);
  void SettleNewcomer(int index, SplitWork* work);
  bool IsConfirmed(const Segment& segment, const cv::Mat_<uchar>& pixels,
                   const SplitWork& work);
  int FindKnown(const Segment& segment, const cv::Mat_<uchar>& pixels,
                const SplitWork& work) const;
  void AddSurface(int known, Segment* segment, SplitWork* work);
  void DrawLabels(SplitWork* work) const;
  void DrawUncertain(SplitWork* work) const;
  void Remember(const SplitWork& work);

  PinholeCamera camera_;
  LabelTable table_;
  SplitOptions options_;
  std::vector<MergeGroup> groups_;
  InstanceRegistry registry_;
  BirthQueue births_;
  MovingObjects objects_;
  MaskSupport support_;
  SurfacePrediction last_;  // Own labels and live depth of the frame before.
  int frames_ = 0;          // Split so far, the current one included.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SURFACE_SPLITTER_H_
