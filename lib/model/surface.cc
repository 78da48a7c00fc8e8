#include "splitfusion/lib/model/surface.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/median.h"
#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/geometry/mesh_pieces.h"
#include "splitfusion/lib/geometry/stretched_area.h"
#include "splitfusion/lib/geometry/triangle_corners.h"
#include "splitfusion/lib/model/canonical_places.h"
#include "splitfusion/lib/model/nodes_facing.h"
#include "splitfusion/lib/model/observe_surface.h"
#include "splitfusion/lib/model/surface_parts.h"
#include "splitfusion/lib/tsdf/forget_voxels.h"
#include "splitfusion/lib/tsdf/release_blocks.h"

namespace splitfusion {
namespace {

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
  return Median(std::move(depths));
}

/// Where the nodes are under their motions, camera frame.
std::vector<Eigen::Vector3f> NodePlaces(const DeformationGraph& graph) {
  std::vector<Eigen::Vector3f> places;
  for (int i = 0; i < graph.size(); ++i) {
    places.push_back(
        (graph.positions[i] + graph.motions[i].translation).cast<float>());
  }
  return places;
}

/// A live point as near as this to a vertex is on the mesh, voxels.
constexpr double kModelledVoxels = 3;

/// How far from its place in the canonical frame a live point may be fused,
/// metres: voxels before and behind it are as far as the truncation, and the
/// cells in which warped voxels are asked for together have an extent. What is
/// carried upon a surface from farther away is a part astray: were it to take
/// the points of that surface, its copy would spread over all of it. That
/// leaves nothing for bends and for places that are rounded to vertices: the
/// outermost voxels of some cells are carved only.
double PlaceTolerance(const TsdfOptions& options) {
  return options.truncation + 4 * options.voxel_size;
}

/// Places of live points that belong to a surface, every fourth pixel.
std::vector<Eigen::Vector3d> PlacesOfSurface(const CanonicalPlaces& found) {
  constexpr int kPixelStride = 4;  // Blocks are many pixels wide.
  std::vector<Eigen::Vector3d> places;
  for (int v = 0; v < found.points.rows; v += kPixelStride) {
    for (int u = 0; u < found.points.cols; u += kPixelStride) {
      const auto coverage = static_cast<Coverage>(found.coverage(v, u));
      if (coverage == Coverage::kNone || coverage == Coverage::kOutOfReach) {
        continue;
      }
      const cv::Vec3f& p = found.points(v, u);
      places.emplace_back(p[0], p[1], p[2]);
    }
  }
  return places;
}

}  // namespace

void SurfaceOptions::List(OptionList* list) {
  list->Part("", &tsdf);
  list->Number("min_piece", &min_piece_area, Range::AtLeast(0), "square metres",
               "Smaller connected pieces of the final mesh are left out.");
  list->Number("mesh_weight", &min_mesh_weight,
               {0, MeshExtractor::kMaxMinWeight, true}, "",
               "Weight that a voxel needs to be meshed (a frame at close range "
               "gives about 1).");
  list->Number("growth_reach", &growth_reach, Range::Above(0), "metres",
               "A deforming surface grows over live points up to this distance "
               "from its nodes.");
}

void SurfaceOptions::Check() const { CheckOptions(*this); }

Surface::Surface(int id, std::string label, SurfaceKind kind, int first_frame,
                 const SurfaceOptions& options,
                 const GraphOptions& graph_options)
    : id_(id),
      label_(std::move(label)),
      kind_(kind),
      first_frame_(first_frame),
      options_(options),
      graph_options_(graph_options),
      volume_(options.tsdf) {}

bool Surface::Initialize(const LiveView& live) {
  const DepthObservation observation = ObserveSurface(live, id_);
  AllocateBand(observation, Rigid3d::Identity(), &volume_);
  // A surface that nothing was seen of could never be tracked.
  if (volume_.leaf_count() == 0) return false;
  IntegrateRigid(observation, Rigid3d::Identity(), &volume_);
  if (!is_ray_cast()) {
    // One noisy view: anything seen once is surface.
    mesh_ = ExtractMesh(volume_, 1e-6);
    if (mesh_.triangles.empty()) return false;
  }
  PlaceGraph(live);
  return true;
}

bool Surface::Reanchor(const LiveView& live) {
  Surface anew(id_, label_, kind_, first_frame_, options_, graph_options_);
  if (!anew.Initialize(live)) return false;
  FinishMesh();
  history_.Finish();
  retired_.Add(std::move(mesh_), std::move(graph_), std::move(history_));
  anew.spool_ = spool_;
  anew.history_ = MotionLog(spool_);
  anew.retired_ = std::move(retired_);
  *this = std::move(anew);
  return true;
}

SurfaceModel Surface::Model() const {
  std::vector<TrackedModel> models;
  for (int i = 0; i < retired_.size(); ++i) models.push_back(retired_.At(i));
  // One that has no frame yet has nothing to show.
  if (!history_.empty() || models.empty()) {
    models.push_back({mesh_, graph_, history_});
  }
  return JoinModels(std::move(models));
}

void Surface::PlaceGraph(const LiveView& live) {
  if (kind_ == SurfaceKind::kRigid) {
    graph_ = MakeRigidGraph(Rigid3d::Identity());
  } else {
    graph_.node_spacing = NodeSpacing(graph_options_, MedianDepth(live, id_));
    graph_record_.planned_spacing = graph_.node_spacing;
    GrowGraph(mesh_, graph_options_, &graph_, nullptr);
  }
  index_ = std::make_unique<SkinningIndex>(graph_,
                                           graph_options_.neighbors_per_point);
  mesh_skinning_ = MeshSkinning(*index_, mesh_.vertices);
}

int Surface::Fuse(const LiveView& live) {
  DepthObservation observation = ObserveSurface(live, id_);
  if (kind_ == SurfaceKind::kNonRigid) return FuseWarped(live, &observation);
  observation.others_refute = true;
  const Rigid3d camera_from_canonical = MeanRigidMotion(graph_);
  AllocateBand(observation, camera_from_canonical, &volume_);
  IntegrateRigid(observation, camera_from_canonical, &volume_);
  return 0;
}

void Surface::Forget(const std::vector<Eigen::Vector3f>& places) {
  ForgetAround(places, options_.tsdf.truncation, &volume_);
}

void Surface::ForgetOther(const LiveView& live, int other) {
  constexpr int kPixelStride = 2;  // Truncations are many pixels wide.
  const Rigid3f canonical_from_camera =
      MeanRigidMotion(graph_).inverse().cast<float>();
  std::vector<Eigen::Vector3f> places;
  for (int v = 0; v < live.depth.rows; v += kPixelStride) {
    for (int u = 0; u < live.depth.cols; u += kPixelStride) {
      if (!IsCertain(live, other, v, u)) continue;
      const cv::Vec3f& p = live.map.points(v, u);
      places.push_back(canonical_from_camera *
                       Eigen::Vector3f(p[0], p[1], p[2]));
    }
  }
  Forget(places);
}

/// Points that are carried back astray leave blocks behind that hold nothing.
void Surface::ReleaseBlocks() {
  constexpr double kGrowth = 1.5;  // Speed: what is kept by block is made anew.
  if (static_cast<double>(volume_.leaf_count()) <
      kGrowth * static_cast<double>(kept_blocks_)) {
    return;
  }
  ReleaseFreeBlocks(&volume_);
  kept_blocks_ = volume_.leaf_count();
  integrator_ = WarpedIntegrator();
  mesh_extractor_ = MeshExtractor();
}

/// Of every vertex whether the node that is nearest to it is confirmed.
std::vector<char> Surface::ConfirmedVertices() const {
  std::vector<char> nodes =
      unconfirmed_.Confirmed(graph_options_.confirmed_frames);
  nodes.resize(graph_.size(), false);  // New ones.
  std::vector<char> vertices;
  for (const SkinningSupport& support : mesh_skinning_.supports()) {
    vertices.push_back(nodes[support.nearest]);
  }
  return vertices;
}

/// Of every node whether it is the nearest one of any of these vertices.
std::vector<char> Surface::NodesOf(const std::vector<int>& vertices) const {
  std::vector<char> nodes(graph_.size(), false);
  for (const int vertex : vertices) {
    nodes[mesh_skinning_.supports()[vertex].nearest] = true;
  }
  return nodes;
}

int Surface::FuseWarped(const LiveView& live, DepthObservation* observation) {
  std::vector<Eigen::Vector3f> warped = WarpedVertices();
  refuted_.Look(live, id_, warped, mesh_skinning(), graph_.size(),
                options_.tsdf.truncation);
  ReleaseBlocks();
  const int forgotten = ForgetRefuted();
  if (forgotten > 0) warped = WarpedVertices();
  const CanonicalPlaces found = FindCanonicalPlaces(
      live, id_, graph_, {mesh_.vertices, warped, ConfirmedVertices()},
      {kModelledVoxels * options_.tsdf.voxel_size, options_.growth_reach});
  unconfirmed_.Look(live, id_, NodePlaces(graph_), NodesOf(found.shown),
                    NodesFacing(mesh_, mesh_skinning_.supports(), graph_),
                    options_.tsdf.truncation);
  AllocateAround(PlacesOfSurface(found), options_.tsdf.truncation, &volume_);
  observation->places = found.points;
  observation->place_tolerance = PlaceTolerance(options_.tsdf);
  integrator_.Integrate(*observation, *index_, WarpField(graph_),
                        options_.growth_reach, &volume_,
                        refuted_.Nodes(1, graph_options_.refuted_frames));
  return forgotten;
}

/// Of every node whether what it carries is refuted, or was never confirmed.
std::vector<char> Surface::NodesToForget() const {
  std::vector<char> nodes = unconfirmed_.Nodes(
      graph_options_.confirmed_frames, graph_options_.unconfirmed_frames);
  nodes.resize(graph_.size(), false);  // New ones.
  if (graph_options_.refuted_frames == 0) return nodes;
  const std::vector<char> refuted =
      refuted_.Nodes(graph_options_.refuted_frames);
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] |= refuted[i];
  return nodes;
}

/// Keeps what some nodes carry for the end.
void Surface::Retire(const std::vector<char>& nodes) {
  if (history_.empty()) return;
  TriangleMesh shown = mesh_;
  shown.triangles = TrianglesOfLargePieces(mesh_, options_.min_piece_area);
  const int now = history_.frame(history_.size() - 1);
  for (SurfacePart& part : PartsOf(shown, mesh_skinning_, graph_, nodes, now)) {
    MotionLog motions = history_.Part(part.nodes, part.graph);
    if (motions.empty()) continue;
    retired_.Add(std::move(part.mesh), std::move(part.graph),
                 std::move(motions));
  }
}

int Surface::ForgetRefuted() {
  const std::vector<char> nodes = NodesToForget();
  const auto count =
      static_cast<int>(std::count(nodes.begin(), nodes.end(), true));
  if (count == 0 || count < graph_options_.refuted_share * graph_.size()) {
    return 0;
  }
  Retire(nodes);
  ForgetVoxels(graph_, *index_, nodes, &volume_);
  refuted_.Forget(nodes);
  unconfirmed_.Forget(nodes);
  UpdateMesh();
  return count;
}

int Surface::Tear(const LiveView& live) {
  const double length = graph_options_.tear_voxels * options_.tsdf.voxel_size;
  if (length == 0 || kind_ == SurfaceKind::kRigid) return 0;
  const std::vector<Eigen::Vector3f> warped = WarpedVertices();
  std::vector<Eigen::Vector3f> places;
  for (const Eigen::Vector3i& t :
       StretchedTriangles(length, mesh_.triangles, warped)) {
    const Eigen::Vector3f middle = TriangleCorners(warped, t).Middle();
    if (LookAt(live, id_, middle, kNoiseAlone) == DepthState::kOccluded) {
      continue;
    }
    for (int k = 0; k < 3; ++k) places.push_back(mesh_.vertices[t[k]]);
  }
  if (places.empty()) return 0;
  ForgetAround(places, options_.tsdf.voxel_size, &volume_);
  UpdateMeshAndGraph(/*retie=*/true);
  return static_cast<int>(places.size() / 3);
}

void Surface::FinishMesh() {
  mesh_ = WithoutSmallPieces(ExtractMesh(volume_, options_.min_mesh_weight),
                             options_.min_piece_area);
  mesh_skinning_ = MeshSkinning(*index_, mesh_.vertices);
}

void Surface::UpdateMesh() { UpdateMeshAndGraph(/*retie=*/false); }

void Surface::UpdateMeshAndGraph(bool retie) {
  mesh_ = mesh_extractor_.Extract(volume_, options_.min_mesh_weight);
  mesh_skinning_.FollowMesh(*index_, mesh_.vertices,
                            mesh_extractor_.kept_from());
  if (kind_ == SurfaceKind::kNonRigid) UpdateGraphOverMesh(retie);
}

void Surface::UpdateGraphOverMesh(bool retie) {
  const NodeChange change =
      UpdateGraph(mesh_, graph_options_, *index_, mesh_skinning_, &graph_,
                  &graph_record_, &history_, retie);
  if (change.none() && !retie) return;
  refuted_.Follow(change);
  unconfirmed_.Follow(change);
  auto updated = std::make_unique<SkinningIndex>(
      graph_, graph_options_.neighbors_per_point);
  const SkinningChange skinning_change(*index_, *updated, graph_, change);
  index_ = std::move(updated);
  integrator_.FollowGraph(*index_, skinning_change, volume_);
  mesh_skinning_.FollowGraph(*index_, mesh_.vertices, skinning_change);
}

std::vector<char> Surface::SeenNodes(const LiveView& live) const {
  std::vector<char> seen(graph_.size(), true);
  if (kind_ == SurfaceKind::kRigid) return seen;
  const DepthTolerance<float> tolerance{
      static_cast<float>(options_.tsdf.truncation)};
  const std::vector<Eigen::Vector3f> places = NodePlaces(graph_);
  for (std::size_t i = 0; i < places.size(); ++i) {
    seen[i] = LookAt(live, id_, places[i], tolerance) == DepthState::kObserved;
  }
  return seen;
}

void Surface::RecordMotions(int frame, bool tracked, std::vector<char> seen) {
  history_.Append({frame, tracked, graph_.motions, std::move(seen)});
  graph_.first_seen.resize(graph_.size(), frame);
}

void Surface::PlaceIn(int i, const Rigid3d& motion) {
  history_.Replace(i, MakeRigidGraph(motion).motions);
}

std::vector<Eigen::Vector3f> Surface::WarpedVertices() const {
  const WarpField warp(graph_);
  std::vector<Eigen::Vector3f> warped(mesh_.vertices.size());
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, warped.size(), 4096),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          warped[i] = warp.WarpPoint(mesh_skinning()[i], mesh_.vertices[i]);
        }
      });
  return warped;
}

}  // namespace splitfusion
