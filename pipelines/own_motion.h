#ifndef SPLITFUSION_PIPELINES_OWN_MOTION_H_
#define SPLITFUSION_PIPELINES_OWN_MOTION_H_

#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

class SurfaceTracker;
struct DeformationGraph;
struct ModelSample;

/// A part of the background under a rigid motion of its own.
struct OwnMotion {
  /// Twice the log-likelihood ratio of "it moved like this" against "it stands
  /// where it was mapped", for the mean model point: by how much the motion
  /// lowers the squared point-to-plane distance to the live depth, in variances
  /// of its noise as tracking weighs it. A distance counts three standard
  /// deviations at most. 0 if the part cannot be tracked on its own.
  double gain = 0;
  /// The motion: from the background's canonical frame to the camera's.
  Rigid3d camera_from_canonical = Rigid3d::Identity();
  /// Mean distance of the model points between this motion and standing still,
  /// metres.
  double way = 0;
};

/// Those of a rendering whose pixels are in `mask` (HxW, 255).
std::vector<ModelSample> SamplesWithin(const cv::Mat_<uchar>& mask,
                                       const std::vector<ModelSample>& samples);

/// Tracks a part of the background on its own, from where it was mapped, in its
/// pixels `mask` (HxW, 255). `part`: its model points; `background`: the motion
/// of the background in this frame; `live`: with the labels of other surfaces,
/// whose pixels tell nothing; `grazing_angle`: radians, as of AssociationGates.
OwnMotion FindOwnMotion(const std::vector<ModelSample>& part,
                        const cv::Mat_<uchar>& mask, const LiveView& live,
                        const DeformationGraph& background,
                        const SurfaceTracker& tracker, double grazing_angle);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_OWN_MOTION_H_
