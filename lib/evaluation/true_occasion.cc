#include "splitfusion/lib/evaluation/true_occasion.h"

#include <cmath>
#include <optional>

#include "splitfusion/lib/evaluation/animated_surface.h"

namespace splitfusion {
namespace {

/// Of a true mesh or pose from a frame, seconds.
constexpr double kMaxTimeDifference = 0.02;

const RecordedFrame* FrameAt(const RecordedRun& run, double timestamp) {
  const RecordedFrame* best = nullptr;
  double best_difference = kMaxTimeDifference;
  for (const RecordedFrame& frame : run.frames) {
    const double difference = std::abs(frame.pose.timestamp - timestamp);
    if (difference <= best_difference) {
      best = &frame;
      best_difference = difference;
    }
  }
  return best;
}

std::optional<Rigid3d> TruePoseAt(const GroundTruth& truth, double timestamp) {
  std::optional<Rigid3d> best;
  double best_difference = kMaxTimeDifference;
  for (const TimedPose& pose : truth.trajectory) {
    const double difference = std::abs(pose.timestamp - timestamp);
    if (difference <= best_difference) {
      best = pose.world_from_camera;
      best_difference = difference;
    }
  }
  return best;
}

}  // namespace

std::vector<TrueOccasion> FindOccasions(const RecordedRun& run,
                                        const GroundTruth& truth) {
  std::vector<TrueOccasion> occasions;
  for (const PosedMeshFile& file : truth.posed_meshes) {
    const RecordedFrame* frame = FrameAt(run, file.timestamp);
    const auto pose = TruePoseAt(truth, file.timestamp);
    if (frame == nullptr || !pose) continue;
    occasions.push_back(
        {file.instance, frame, *pose, ReadTrueSurface(file.path)});
  }
  return occasions;
}

TriangleMesh ModelInWorld(const AnimatedSurface& surface,
                          const TrueOccasion& occasion) {
  TriangleMesh mesh = surface.MeshAt(occasion.frame->index);
  // Without triangles it would be taken for a cloud of all its vertices.
  if (mesh.triangles.empty()) return {};
  const Rigid3f world_from_camera = occasion.world_from_camera.cast<float>();
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex = world_from_camera * vertex;
  }
  return mesh;
}

}  // namespace splitfusion
