#ifndef SPLITFUSION_TOOLS_BENCHMARK_GROWTH_PEOPLE_SCENE_H_
#define SPLITFUSION_TOOLS_BENCHMARK_GROWTH_PEOPLE_SCENE_H_

#include <vector>

#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"

namespace splitfusion {

/// The synthetic room with up to four people side by side, who gesture where
/// they stand; the camera is hand-held. Depth is as noisy as a Kinect's.
class PeopleScene {
 public:
  static constexpr int kMost = 4;  ///< People that there is room for.

  /// Images of `height` pixels, 4:3.
  PeopleScene(int people, int height);

  /// Intrinsics.
  const PinholeCamera& camera() const { return camera_; }

  /// A frame, 30 a second; labels are 1 for the first person and so on.
  SyntheticFrame Render(int frame) const;

  /// The exact masks of its people.
  std::vector<InstanceMask> Detections(const SyntheticFrame& frame) const;

 private:
  /// Surface of a person in a frame, camera frame.
  PosedSurface Pose(int person, int frame,
                    const Rigid3d& world_from_camera) const;

  int people_;
  SyntheticOptions options_;
  PinholeCamera camera_;
  CameraPath camera_path_;
  Room room_;
  BodyModel body_;
  BodyMotion motion_{/*walks=*/false};
  std::vector<TexturedMesh> rest_;  ///< Of every person.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_GROWTH_PEOPLE_SCENE_H_
