#include "splitfusion/lib/evaluation/surface_attachment.h"

#include <Eigen/Geometry>
#include <utility>

namespace splitfusion {
namespace {

/// Triangles of which the camera at the origin sees the outside.
std::vector<Eigen::Vector3i> FacingTriangles(
    const std::vector<Eigen::Vector3f>& vertices,
    const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<Eigen::Vector3i> facing;
  for (const Eigen::Vector3i& t : triangles) {
    const Eigen::Vector3f& a = vertices[t[0]];
    const Eigen::Vector3f normal =
        (vertices[t[1]] - a).cross(vertices[t[2]] - a);
    if (normal.dot(a) < 0) facing.push_back(t);
  }
  return facing;
}

}  // namespace

Eigen::Vector3d Attachment::PositionAt(const WarpField& warp) const {
  const NodeMotion motion = warp.BlendMotion(skinning, canonical);
  return canonical.cast<double>() + motion.translation +
         motion.rotation * offset;
}

SurfaceAttacher::SurfaceAttacher(
    const std::vector<const AnimatedSurface*>& surfaces, int frame) {
  for (const AnimatedSurface* surface : surfaces) {
    const std::vector<Eigen::Vector3f> vertices = surface->VerticesAt(frame);
    std::vector<Eigen::Vector3i> facing =
        FacingTriangles(vertices, surface->TrianglesInUse(frame));
    TriangleTree tree(vertices, facing);
    candidates_.push_back(
        {surface, surface->WarpAt(frame), std::move(facing), std::move(tree)});
  }
}

std::optional<Attachment> SurfaceAttacher::Attach(const Eigen::Vector3d& point,
                                                  int preferred_id) const {
  const Candidate* best = nullptr;
  SurfacePoint best_point;
  int best_rank = 3;
  for (const Candidate& candidate : candidates_) {
    const SurfacePoint nearest = candidate.tree.Closest(
        point.cast<float>(), static_cast<float>(kAttachmentDistance));
    if (nearest.triangle < 0) continue;
    const int id = candidate.surface->recorded().id;
    int rank = 2;
    if (preferred_id != 0 && id == preferred_id) {
      rank = 0;
    } else if (id != 0 && nearest.distance <= kForegroundDistance) {
      rank = 1;
    }
    if (rank < best_rank ||
        (rank == best_rank && nearest.distance < best_point.distance)) {
      best = &candidate;
      best_point = nearest;
      best_rank = rank;
    }
  }
  if (best == nullptr) return std::nullopt;
  return Tie(*best, best_point, point);
}

Attachment SurfaceAttacher::Tie(const Candidate& candidate,
                                const SurfacePoint& nearest,
                                const Eigen::Vector3d& point) {
  const auto& vertices = candidate.surface->recorded().mesh.vertices;
  const Eigen::Vector3i& t = candidate.triangles[nearest.triangle];
  Attachment attachment;
  attachment.surface = candidate.surface;
  attachment.canonical.setZero();
  for (int k = 0; k < 3; ++k) {
    attachment.canonical += nearest.barycentric[k] * vertices[t[k]];
  }
  attachment.skinning = candidate.surface->Skin(attachment.canonical);
  const NodeMotion motion =
      candidate.warp.BlendMotion(attachment.skinning, attachment.canonical);
  const Eigen::Vector3d model_point =
      attachment.canonical.cast<double>() + motion.translation;
  attachment.offset = motion.rotation.transpose() * (point - model_point);
  return attachment;
}

}  // namespace splitfusion
