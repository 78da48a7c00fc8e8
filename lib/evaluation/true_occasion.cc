#include "splitfusion/lib/evaluation/true_occasion.h"

#include <cmath>

#include "splitfusion/lib/evaluation/animated_surface.h"

namespace splitfusion {
namespace {

double TimeOf(const RecordedFrame& frame) { return frame.pose.timestamp; }
double TimeOf(const TimedPose& pose) { return pose.timestamp; }

/// The item nearest in time, the last of several; null if none is near.
template <typename Item>
const Item* FindAt(const std::vector<Item>& items, double timestamp) {
  const Item* best = nullptr;
  double best_difference = kMaxTimeDifference;
  for (const Item& item : items) {
    const double difference = std::abs(TimeOf(item) - timestamp);
    if (difference <= best_difference) {
      best = &item;
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
    const RecordedFrame* frame = FindAt(run.frames, file.timestamp);
    const TimedPose* pose = FindAt(truth.trajectory, file.timestamp);
    if (frame == nullptr || pose == nullptr) continue;
    occasions.push_back({file.instance, frame, pose->world_from_camera,
                         ReadTrueSurface(file.path)});
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
