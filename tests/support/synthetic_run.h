#ifndef SPLITFUSION_TESTS_SUPPORT_SYNTHETIC_RUN_H_
#define SPLITFUSION_TESTS_SUPPORT_SYNTHETIC_RUN_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "splitfusion/lib/synthetic/synthetic_scene.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {

/// The method on a synthetic scene, in memory.
class SyntheticRun {
 public:
  /// Changes an input frame and its detections before they are processed.
  using Spoil = std::function<void(Frame*, std::vector<InstanceMask>*)>;

  /// Thresholds in pixels hold for 640x480 and are scaled to the scene's size.
  explicit SyntheticRun(const SyntheticOptions& scene_options,
                        PipelineOptions options = {},
                        const Registries& registries = {});

  /// Processes the next frame of the scene.
  FrameReport Next(const Spoil& spoil = {});

  /// All that later frames depend on, as an archive.
  std::string State() const;

  /// Goes on from a State() of such a run: with a new object, as a new process
  /// would.
  void RestartFrom(const std::string& state);

  const SyntheticScene& scene() const { return scene_; }
  SplitFusion& fusion() { return *fusion_; }
  /// The last frame that was processed, as the scene made it.
  const SyntheticFrame& frame() const { return frame_; }

  /// Poses of the ground truth up to the last frame.
  Trajectory TrueTrajectory() const;

  /// Median distance between rendered model and true depth of the last frame,
  /// metres, over the pixels of one surface that both have.
  double MedianDepthError(int surface) const;

  /// Options of a small scene that is quick to process: 160x120, no noise,
  /// exact masks.
  static SyntheticOptions Quick();

 private:
  class Detections;

  std::unique_ptr<SplitFusion> MakeFusion() const;

  SyntheticScene scene_;
  PipelineOptions options_;
  Registries registries_;
  std::shared_ptr<Detections> detections_;
  std::unique_ptr<SplitFusion> fusion_;
  SyntheticFrame frame_;
  int next_ = 0;
};

/// Whether motions, meshes and trajectories of two runs are the same bytes.
bool SameResults(const SplitFusion& a, const SplitFusion& b);

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_SYNTHETIC_RUN_H_
