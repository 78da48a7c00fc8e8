#include "splitfusion/pipelines/surface.h"

#include <algorithm>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/geometry/mesh_pieces.h"
#include "splitfusion/lib/geometry/nearest_point.h"

namespace splitfusion {
namespace {

/// What every live pixel may do to the volume of one surface.
DepthObservation Observe(const LiveView& live, int id) {
  DepthObservation observation;
  observation.camera = live.camera;
  observation.depth = live.depth;
  observation.weight = live.confidence;
  observation.color = live.color;
  observation.role.create(live.depth.size());
  for (int v = 0; v < live.depth.rows; ++v) {
    for (int u = 0; u < live.depth.cols; ++u) {
      PixelRole role = PixelRole::kNone;
      if (live.uncertain(v, u) == 0 && live.edges(v, u) == 0) {
        role = live.labels(v, u) == id ? PixelRole::kWrite : PixelRole::kCarve;
      }
      observation.role(v, u) = static_cast<std::uint8_t>(role);
    }
  }
  return observation;
}

/// Median depth of a surface's live pixels, metres; 0 if it has none.
double MedianDepth(const LiveView& live, int id) {
  std::vector<float> depths;
  for (int v = 0; v < live.depth.rows; ++v) {
    for (int u = 0; u < live.depth.cols; ++u) {
      if (live.labels(v, u) == id && live.depth(v, u) > 0) {
        depths.push_back(live.depth(v, u));
      }
    }
  }
  if (depths.empty()) return 0;
  const auto middle = depths.begin() + depths.size() / 2;
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

}  // namespace

void SurfaceOptions::Check() const {
  tsdf.Check();
  graph.Check();
  CheckOption(min_mesh_weight > 0, "min_mesh_weight", min_mesh_weight, "> 0");
  CheckOption(min_piece_area >= 0, "min_piece_area", min_piece_area,
              "square metres, >= 0");
  CheckOption(growth_reach > 0, "growth_reach", growth_reach, "metres > 0");
}

Surface::Surface(int id, std::string label, SurfaceKind kind, int first_frame,
                 const SurfaceOptions& options)
    : id_(id),
      label_(std::move(label)),
      kind_(kind),
      first_frame_(first_frame),
      options_(options),
      volume_(options.tsdf) {}

bool Surface::Initialize(const LiveView& live) {
  const DepthObservation observation = Observe(live, id_);
  AllocateBand(observation, Rigid3d::Identity(), &volume_);
  // A surface that nothing was seen of could never be tracked.
  if (volume_.leaf_count() == 0) return false;
  IntegrateRigid(observation, Rigid3d::Identity(), &volume_);
  if (!is_ray_cast()) {
    // One noisy view: anything seen once is surface.
    mesh_ = ExtractMesh(volume_, 1e-3);
    if (mesh_.triangles.empty()) return false;
  }
  PlaceGraph(live);
  return true;
}

void Surface::PlaceGraph(const LiveView& live) {
  if (kind_ == SurfaceKind::kRigid) {
    graph_ = MakeRigidGraph(Rigid3d::Identity());
  } else {
    planned_node_spacing_ = NodeSpacing(options_.graph, MedianDepth(live, id_));
    graph_.node_spacing = planned_node_spacing_;
    GrowGraph(mesh_, options_.graph, &graph_, nullptr);
  }
  RefreshSkinning();
}

void Surface::RefreshSkinning() {
  index_ = std::make_unique<SkinningIndex>(graph_,
                                           options_.graph.neighbors_per_point);
  integrator_.InvalidateSkinning();
  if (kind_ == SurfaceKind::kNonRigid) {
    AllocateAround(graph_.positions,
                   graph_.node_spacing + options_.tsdf.truncation, &volume_);
  }
  mesh_skinning_ = index_->Skin(mesh_.vertices);
}

void Surface::Fuse(const LiveView& live) {
  const DepthObservation observation = Observe(live, id_);
  if (kind_ == SurfaceKind::kRigid) {
    const Rigid3d camera_from_canonical = MeanRigidMotion(graph_);
    AllocateBand(observation, camera_from_canonical, &volume_);
    IntegrateRigid(observation, camera_from_canonical, &volume_);
  } else {
    AllocateUncovered(live);
    integrator_.Integrate(observation, *index_, WarpField(graph_),
                          options_.growth_reach, &volume_);
  }
}

void Surface::AllocateUncovered(const LiveView& live) {
  std::vector<Eigen::Vector3f> centers;
  for (int i = 0; i < graph_.size(); ++i) {
    centers.push_back(
        (graph_.positions[i] + graph_.motions[i].translation).cast<float>());
  }
  const NearestPoint nodes(centers);
  std::vector<Eigen::Vector3d> uncovered;
  int node = -1;
  constexpr int kPixelStride = 4;
  for (int v = 0; v < live.depth.rows; v += kPixelStride) {
    for (int u = 0; u < live.depth.cols; u += kPixelStride) {
      if (live.labels(v, u) != id_ || !(live.depth(v, u) > 0) ||
          live.edges(v, u) != 0 || live.uncertain(v, u) != 0) {
        continue;
      }
      const cv::Vec3f& p = live.map.points(v, u);
      const Eigen::Vector3f point(p[0], p[1], p[2]);
      float distance = 0;
      node = nodes.Find(point, node, &distance);
      if (distance < graph_.node_spacing || distance > options_.growth_reach) {
        continue;
      }
      // Eq. 1 of the nearest node, inverted.
      const Eigen::Vector3d offset =
          point.cast<double>() - centers[node].cast<double>();
      uncovered.push_back(graph_.motions[node].rotation.transpose() * offset +
                          graph_.positions[node]);
    }
  }
  AllocateAround(uncovered, options_.tsdf.truncation, &volume_);
}

void Surface::FinishMesh() {
  mesh_ = WithoutSmallPieces(ExtractMesh(volume_, options_.min_mesh_weight),
                             options_.min_piece_area);
  mesh_skinning_ = index_->Skin(mesh_.vertices);
}

void Surface::UpdateMesh() {
  mesh_ = mesh_extractor_.Extract(volume_, options_.min_mesh_weight);
  if (kind_ == SurfaceKind::kNonRigid &&
      GrowGraph(mesh_, options_.graph, &graph_, &history_) > 0) {
    RefreshSkinning();
  } else {
    mesh_skinning_ = index_->Skin(mesh_.vertices);
  }
}

void Surface::RecordMotions(int frame, bool tracked) {
  history_.frames.push_back({frame, tracked, graph_.motions});
}

std::vector<Eigen::Vector3f> Surface::WarpedVertices() const {
  const WarpField warp(graph_);
  std::vector<Eigen::Vector3f> warped(mesh_.vertices.size());
  for (std::size_t i = 0; i < warped.size(); ++i) {
    warped[i] = warp.WarpPoint(mesh_skinning_[i], mesh_.vertices[i]);
  }
  return warped;
}

}  // namespace splitfusion
