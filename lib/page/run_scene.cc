#include "splitfusion/lib/page/run_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/pi.h"
#include "splitfusion/lib/evaluation/recorded_run.h"
#include "splitfusion/lib/geometry/stretched_area.h"
#include "splitfusion/lib/page/packed_arrays.h"
#include "splitfusion/lib/page/scene_fields.h"
#include "splitfusion/lib/page/scene_mesh.h"
#include "splitfusion/lib/sequence/calibration.h"
#include "splitfusion/lib/visibility/seen_triangles.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;
using Values = std::vector<std::int32_t>;

constexpr double kMotions = 2e6;  // Layout. Nodes times frames of all surfaces.
constexpr int kVertices = 30000;  // Layout. Of a surface.
constexpr double kUnit = 4e-5;    // Layout. Of places, metres.
constexpr double kRotationUnit = 1e-4;      // Layout. Of a unit quaternion.
constexpr double kWeightUnit = 1.0 / 8191;  // Layout. Of weights of Eq. 3.

std::int32_t InUnits(double value, double unit) {
  return static_cast<std::int32_t>(std::lround(value / unit));
}

/// A surface with what a page needs of it.
struct SceneSurface {
  const RecordedSurface& recorded;
  SmallerMesh smaller;
  std::vector<Skinning> skinning;  // Of the vertices of `smaller`.
  std::vector<int> shown;   // Frames of the scene that it has motions in,
  std::vector<int> places;  // and where these are in the scene.
};

template <typename Points>
Values PlacesInUnits(const Points& points) {
  Values values;
  for (const auto& point : points) {
    for (int k = 0; k < 3; ++k) values.push_back(InUnits(point[k], kUnit));
  }
  return values;
}

Values Corners(const TriangleMesh& mesh) {
  Values values;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    values.insert(values.end(), t.data(), t.data() + 3);
  }
  return values;
}

Values Colors(const TriangleMesh& mesh) {
  Values values;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      values.push_back(mesh.colors.empty() ? 160 : mesh.colors[i][k]);
    }
  }
  return values;
}

/// Of every vertex its nodes and their weights, `per_vertex` of each.
std::pair<Values, Values> Influences(const std::vector<Skinning>& skinning,
                                     int per_vertex) {
  Values nodes, weights;
  for (const Skinning& one : skinning) {
    for (int k = 0; k < per_vertex; ++k) {
      const bool used = k < one.count;
      nodes.push_back(used ? one.nodes[k] : one.nodes[0]);
      weights.push_back(used ? InUnits(one.weights[k], kWeightUnit) : 0);
    }
  }
  return {nodes, weights};
}

/// Of every triangle the first frame in which it had been seen, and the one
/// behind the last, by place in the scene.
Values SeenIntervals(const SceneSurface& surface,
                     const std::vector<int>& frames) {
  const TriangleMesh& mesh = surface.smaller.mesh;
  Values seen(2 * mesh.triangles.size(), 0);
  for (const int place : surface.places) {
    std::size_t t = 0;
    for (const Eigen::Vector3i& triangle : SeenTriangles(
             mesh, surface.skinning, surface.recorded.graph, frames[place])) {
      while (mesh.triangles[t] != triangle) ++t;  // They are in order.
      if (seen[2 * t + 1] == 0) seen[2 * t] = place;
      seen[2 * t + 1] = place + 1;
      ++t;
    }
  }
  return seen;
}

/// The same of every node.
Values UsedIntervals(const SceneSurface& surface,
                     const std::vector<int>& frames) {
  const DeformationGraph& graph = surface.recorded.graph;
  const bool known = static_cast<int>(graph.first_seen.size()) == graph.size();
  Values used(2 * graph.size(), 0);
  for (const int place : surface.places) {
    for (int node = 0; node < graph.size(); ++node) {
      if (!graph.IsInUse(node, frames[place]) ||
          (known && graph.first_seen[node] > frames[place])) {
        continue;
      }
      if (used[2 * node + 1] == 0) used[2 * node] = place;
      used[2 * node + 1] = place + 1;
    }
  }
  return used;
}

Values Edges(const DeformationGraph& graph) {
  Values edges;
  for (int node = 0; node < static_cast<int>(graph.neighbors.size()); ++node) {
    for (const int other : graph.neighbors[node]) {
      const std::vector<int>& back = graph.neighbors[other];
      const bool twice =
          std::find(back.begin(), back.end(), node) != back.end();
      if (!twice || node < other) edges.insert(edges.end(), {node, other});
    }
  }
  return edges;
}

/// Quaternion (x, y, z, w) and translation of all nodes in all frames: by
/// component, frame, node.
Values Motions(const SceneSurface& surface) {
  const std::size_t nodes = surface.recorded.graph.positions.size();
  const std::size_t count = nodes * surface.shown.size();
  Values values(7 * count);
  std::vector<Eigen::Vector4d> before(nodes, Eigen::Vector4d::Zero());
  std::size_t at = 0;
  const DeformationGraph& graph = surface.recorded.graph;
  const MotionHistory& history = surface.recorded.motions;
  const PartEnds ends = EndsOfParts(history, graph);
  for (const int frame : surface.shown) {
    const std::vector<NodeMotion> motions =
        MotionsOfAll(history, graph, ends, frame);
    for (std::size_t n = 0; n < nodes; ++n, ++at) {
      Eigen::Vector4d turn = Eigen::Quaterniond(motions[n].rotation).coeffs();
      // Of the two that are the same rotation, the one like the last.
      if (turn.dot(before[n]) < 0) turn = -turn;
      before[n] = turn;
      for (int c = 0; c < 4; ++c) {
        values[c * count + at] = InUnits(turn[c], kRotationUnit);
      }
      for (int c = 0; c < 3; ++c) {
        values[(4 + c) * count + at] =
            InUnits(motions[n].translation[c], kUnit);
      }
    }
  }
  return values;
}

Json ArraysOf(const SceneSurface& surface, const std::vector<int>& frames,
              int per_vertex, PackedArrays* arrays) {
  const TriangleMesh& mesh = surface.smaller.mesh;
  const DeformationGraph& graph = surface.recorded.graph;
  const auto [nodes, weights] = Influences(surface.skinning, per_vertex);
  return {
      {"vertices", arrays->Add(PlacesInUnits(mesh.vertices), 3)},
      {"colors", arrays->Add(Colors(mesh), 3)},
      {"source",
       arrays->Add(
           {surface.smaller.source.begin(), surface.smaller.source.end()}, 1)},
      {"influences", arrays->Add(nodes, per_vertex)},
      {"weights", arrays->Add(weights, per_vertex)},
      {"triangles", arrays->Add(Corners(mesh), 3)},
      {"seen", arrays->Add(SeenIntervals(surface, frames), 2)},
      {"positions", arrays->Add(PlacesInUnits(graph.positions), 3)},
      {"edges", arrays->Add(Edges(graph), 2)},
      {"used", arrays->Add(UsedIntervals(surface, frames), 2)},
      {"motions", arrays->Add(Motions(surface), graph.size())},
  };
}

/// Where a frame is in the scene; -1: it is not.
int PlaceOf(int frame, const std::vector<int>& frames) {
  const auto found = std::lower_bound(frames.begin(), frames.end(), frame);
  return found == frames.end() || *found != frame
             ? -1
             : static_cast<int>(found - frames.begin());
}

/// Packs a field in the frames of the scene; says where it is in `where`.
Json PackField(const NodeField& field, const std::vector<int>& frames,
               int nodes, Json* where, PackedArrays* arrays) {
  std::vector<int> places;
  Values values;
  for (std::size_t row = 0; row < field.frames.size(); ++row) {
    const int place = PlaceOf(field.frames[row], frames);
    if (place < 0) continue;
    places.push_back(place);
    const auto begin = field.values.begin() + row * nodes;
    values.insert(values.end(), begin, begin + nodes);
  }
  (*where)[field.name] = arrays->Add(values, nodes);
  return {{"frames", places},
          {"holds", field.holds},
          {"unit", NodeField::kUnit},
          {"top", field.top}};
}

SceneSurface MakeSurface(const RecordedSurface& recorded,
                         const std::vector<int>& frames) {
  SceneSurface surface{
      recorded, SimplifiedMesh(recorded.mesh, kVertices), {}, {}, {}};
  surface.skinning = SkinningIndex(recorded.graph, recorded.neighbors_per_point)
                         .Skin(surface.smaller.mesh.vertices);
  for (int i = 0; i < recorded.motions.size(); ++i) {
    const int frame = recorded.motions.frame(i);
    const int place = PlaceOf(frame, frames);
    if (place < 0) continue;
    surface.shown.push_back(frame);
    surface.places.push_back(place);
  }
  return surface;
}

/// A surface as the viewer reads it. `about`: gathers what fields there are.
Json SurfaceOf(const SceneSurface& surface, const SurfaceCurves& curves,
               const std::vector<int>& frames,
               const std::vector<NodeField>& fields, Json* about,
               PackedArrays* arrays) {
  const int nodes = surface.recorded.graph.size();
  const int per_vertex = std::min(nodes, surface.recorded.neighbors_per_point);
  Json where = ArraysOf(surface, frames, per_vertex, arrays);
  Json packed = Json::object();
  for (const NodeField& field : fields) {
    (*about)[field.name] = {{"title", field.title}, {"top", field.top}};
    packed[field.name] = PackField(field, frames, nodes, &where, arrays);
  }
  return {{"name", curves.name},
          {"unit", kUnit},
          {"rotation_unit", kRotationUnit},
          {"stretched", kStretchedEdge},
          {"per_vertex", per_vertex},
          {"nodes", nodes},
          {"frames", surface.places},
          {"fields", packed},
          {"arrays", where}};
}

/// Every n-th position of the run's frames, so that the motions of all nodes
/// are not too many for a page.
std::vector<int> PositionsShown(const ReportedRun& run) {
  double motions = 0;
  for (const Json& surface : run.summary.at("surfaces")) {
    motions += surface.at("nodes").get<double>();
  }
  const int count = static_cast<int>(run.curves.frames.size());
  const int step =
      std::max(1, static_cast<int>(std::ceil(motions * count / kMotions)));
  std::vector<int> positions;
  for (int i = 0; i < count; i += step) positions.push_back(i);
  return positions;
}

/// Poses of the camera in some of the run's frames.
Json PosesOf(const RunPaths& paths, std::size_t frames,
             const std::vector<int>& positions) {
  const Trajectory trajectory = ReadTumTrajectory(paths.Trajectory());
  if (trajectory.size() != frames) {
    throw InputError(paths.Trajectory() + ": has " +
                     std::to_string(trajectory.size()) +
                     " poses: expected one for each frame of frames.jsonl, " +
                     std::to_string(frames));
  }
  Json poses = Json::array();
  for (const int position : positions) {
    const Rigid3d& pose = trajectory[position].world_from_camera;
    const Eigen::Vector3d place = pose.translation();
    const Eigen::Quaterniond turn(pose.linear());
    poses.push_back({place.x(), place.y(), place.z(), turn.x(), turn.y(),
                     turn.z(), turn.w()});
  }
  return poses;
}

/// Vertical field of view, degrees.
double FieldOfView(const RunPaths& paths) {
  const PinholeCamera camera = ReadCalibrationLine(paths.Calibration()).camera;
  return 2 * std::atan(camera.height / (2 * camera.fy)) * 180 / kPi<double>;
}

}  // namespace

RunScene SceneOfRun(const ReportedRun& run) {
  const RunPaths paths(run.folder);
  const std::vector<int> positions = PositionsShown(run);
  std::vector<int> frames;
  for (const int position : positions) {
    frames.push_back(run.curves.frames[position]);
  }
  PackedArrays arrays;
  Json surfaces = Json::array(), fields = Json::object();
  for (const SurfaceCurves& curves : run.curves.surfaces) {
    const RecordedSurface recorded =
        ReadRecordedSurface(run.folder + "/surfaces/" + curves.name);
    Json surface = SurfaceOf(MakeSurface(recorded, frames), curves, frames,
                             FieldsOf(paths, recorded), &fields, &arrays);
    for (const int position : positions) {
      surface["states"].push_back(curves.states[position]);
    }
    surfaces.push_back(surface);
  }
  RunScene scene;
  scene.header = {
      {"frames", frames},
      {"poses", PosesOf(paths, run.curves.frames.size(), positions)},
      {"fov", FieldOfView(paths)},
      {"fields", fields},
      {"surfaces", surfaces}};
  scene.arrays = arrays.Text();
  return scene;
}

}  // namespace splitfusion
