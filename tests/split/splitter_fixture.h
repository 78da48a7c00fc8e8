#ifndef SPLITFUSION_TESTS_SPLIT_SPLITTER_FIXTURE_H_
#define SPLITFUSION_TESTS_SPLIT_SPLITTER_FIXTURE_H_

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "split/layered_scene.h"
#include "splitfusion/lib/split/surface_splitter.h"

namespace splitfusion {

/// Splits scenes frame by frame.
class SplitterTest : public testing::Test {
 protected:
  /// Splits the next frame; the last one stands in for an empty prediction.
  SplitResult Split(LayeredScene& scene,
                    const std::vector<InstanceMask>& detections,
                    const SurfacePrediction& prediction = {}) {
    const Frame frame = scene.MakeFrame(next_frame_++);
    last_ = splitter_.Split(frame, ComputePointMap(frame.depth, SceneCamera()),
                            detections, prediction);
    return last_;
  }
  /// Number of decisions of this kind in the last frame.
  int Count(const std::string& action) const {
    int count = 0;
    for (const SplitDecision& decision : last_.decisions) {
      count += decision.action == action;
    }
    return count;
  }
  double IouOf(int id, const cv::Mat& truth) const {
    return Iou(last_.labels == id, truth);
  }
  void UseOptions(const SplitOptions& options) {
    splitter_ = SurfaceSplitter(SceneCamera(), LabelTable(), options);
  }

  SurfaceSplitter splitter_{SceneCamera(), LabelTable(), SceneOptions()};
  SplitResult last_;
  int next_frame_ = 0;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SPLIT_SPLITTER_FIXTURE_H_
