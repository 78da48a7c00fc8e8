#ifndef SPLITFUSION_LIB_SYNTHETIC_SYNTHETIC_SCENE_H_
#define SPLITFUSION_LIB_SYNTHETIC_SYNTHETIC_SCENE_H_

#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/sequence/frame.h"
#include "splitfusion/lib/synthetic/body_model.h"
#include "splitfusion/lib/synthetic/body_motion.h"
#include "splitfusion/lib/synthetic/camera_path.h"
#include "splitfusion/lib/synthetic/room.h"
#include "splitfusion/lib/synthetic/shading.h"
#include "splitfusion/lib/synthetic/soft_object.h"
#include "splitfusion/lib/synthetic/synthetic_options.h"

namespace splitfusion {

/// A thing of the scene that a detector may find.
struct SyntheticInstance {
  int id = 0;            ///< Pixel value in label images, from 1.
  std::string name;      ///< "person1", "toy", "chair1".
  std::string category;  ///< COCO class.
  bool rigid = false;    ///< Does not deform.
  bool moving = true;    ///< Moves against the room.
};

/// One rendered frame with its ground truth.
struct SyntheticFrame {
  Frame frame;         ///< Colour and measured (noisy) depth.
  cv::Mat true_depth;  ///< HxW 32FC1, metres, exact; 0 = nothing there.
  cv::Mat labels;      ///< HxW 8UC1 instance id; 0 = background.
  Rigid3d world_from_camera = Rigid3d::Identity();  ///< Exact pose.
};

/// A point that sticks to the surface of an instance: (1 - b1 - b2) v0 + b1 v1
/// + b2 v2 of a triangle of its posed mesh.
struct ScenePoint {
  int instance = 0;  ///< Instance id.
  int triangle = 0;  ///< Index in the posed mesh.
  float b1 = 0;      ///< Barycentric weight of the second corner.
  float b2 = 0;      ///< Barycentric weight of the third corner.
};

/// The synthetic world: renders any frame on demand, in any order; the same
/// options and frame index give the same pixels. Building one takes about 0.1
/// s.
///
/// World frame: z up, metres, the floor at z = 0.
class SyntheticScene {
 public:
  /// @throw InputError if an option is out of its range.
  explicit SyntheticScene(const SyntheticOptions& options);

  /// The options it was built with.
  const SyntheticOptions& options() const { return options_; }

  /// Intrinsics of every frame.
  const PinholeCamera& camera() const { return camera_; }

  /// What the scene contains, moving things first; ids as in the labels.
  const std::vector<SyntheticInstance>& instances() const { return instances_; }

  /// Time stamp of a frame, seconds since the epoch.
  double Timestamp(int frame) const;

  /// Stem of a frame's files: the time stamp with six decimals.
  std::string Stem(int frame) const;

  /// Exact camera pose of a frame.
  Rigid3d WorldFromCamera(int frame) const;

  /// Renders a frame, 0 to frames - 1.
  ///
  /// @throw InputError if there is no such frame.
  SyntheticFrame Render(int frame) const;

  /// What a detector finds in a frame: exact masks with
  /// SyntheticOptions::exact_masks, else wobbly and sometimes missed ones.
  std::vector<InstanceMask> Detections(const SyntheticFrame& frame) const;

  /// Everything that never moves, world frame; empty without a room.
  const TriangleMesh& static_mesh() const { return room_.surface.mesh; }

  /// Instance id of every triangle of static_mesh().
  const std::vector<std::uint8_t>& static_triangle_instances() const {
    return room_.surface.triangle_instances;
  }

  /// Walls (first) and furniture as solids; empty without a room.
  const std::vector<Solid>& solids() const { return room_.solids; }

  /// Mesh of a moving instance in a frame, world frame, with normals; the order
  /// of vertices never changes.
  ///
  /// @throw InputError if the instance does not move or is not in the scene.
  TriangleMesh PosedMesh(int instance, int frame) const;

  /// Points spread evenly over the non-rigid instances, by instance.
  const std::vector<ScenePoint>& track_points() const { return track_points_; }

  /// World positions of track_points() in a frame, metres.
  std::vector<Eigen::Vector3f> TrackPositions(int frame) const;

  /// Which of track_points() are seen in a rendered frame.
  std::vector<bool> TrackVisibility(const SyntheticFrame& frame) const;

 private:
  double SubjectTime(int frame) const;
  std::vector<Eigen::Vector3f> PosedVertices(int instance, int frame) const;
  const TexturedMesh& RestMesh(int instance) const;
  void AddInstances();
  void AddTrackPoints();
  std::vector<PosedSurface> PosedSurfaces(int frame) const;

  SyntheticOptions options_;
  PinholeCamera camera_;
  CameraPath camera_path_;
  Room room_;
  std::unique_ptr<const BodyModel> body_;
  BodyMotion body_motion_;
  std::unique_ptr<const SoftObject> soft_object_;
  std::vector<SyntheticInstance> instances_;
  std::vector<ScenePoint> track_points_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_SYNTHETIC_SCENE_H_
