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

constexpr int kVertices = 30000;            // Layout. Of a surface.
constexpr double kUnit = 1e-4;              // Layout. Of places, metres.
constexpr double kRotationUnit = 2.5e-4;    // Layout. Of a unit quaternion.
constexpr double kWeightUnit = 1.0 / 2047;  // Layout. Of weights of Eq. 3.

std::int32_t InUnits(double value, double unit) {
  return static_cast<std::int32_t>(std::lround(value / unit));
}

/// A surface with what a page needs of it.
struct SceneSurface {
  const RecordedSurface& recorded;
  SmallerMesh smaller;
  std::vector<Skinning> skinning;  // Of the vertices of `smaller`.
  std::vector<int> places;         // In the scene, of its motions' frames.
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
Values Motions(const RecordedSurface& surface) {
  const std::size_t nodes = surface.graph.positions.size();
  const std::size_t count = nodes * surface.motions.frames.size();
  Values values(7 * count);
  std::vector<Eigen::Vector4d> before(nodes, Eigen::Vector4d::Zero());
  std::size_t at = 0;
  for (const FrameMotions& frame : surface.motions.frames) {
    for (std::size_t n = 0; n < nodes; ++n, ++at) {
      Eigen::Vector4d turn =
          Eigen::Quaterniond(frame.motions[n].rotation).coeffs();
      // Of the two that are the same rotation, the one like the last.
      if (turn.dot(before[n]) < 0) turn = -turn;
      before[n] = turn;
      for (int c = 0; c < 4; ++c) {
        values[c * count + at] = InUnits(turn[c], kRotationUnit);
      }
      for (int c = 0; c < 3; ++c) {
        values[(4 + c) * count + at] =
            InUnits(frame.motions[n].translation[c], kUnit);
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
      {"motions", arrays->Add(Motions(surface.recorded), graph.size())},
  };
}

/// Where each of some frames is in the scene.
std::vector<int> PlacesOf(const std::vector<int>& some,
                          const std::vector<int>& frames,
                          const std::string& name) {
  std::vector<int> places;
  for (const int frame : some) {
    const auto found = std::lower_bound(frames.begin(), frames.end(), frame);
    if (found == frames.end() || *found != frame) {
      throw InputError("surface " + name + " is known in frame " +
                       std::to_string(frame) +
                       ": expected frames of frames.jsonl");
    }
    places.push_back(static_cast<int>(found - frames.begin()));
  }
  return places;
}

/// Packs the fields of a surface; `about`: what is known of fields of any.
Json PackFields(const std::vector<NodeField>& fields, const std::string& name,
                const std::vector<int>& frames, int nodes, Json* about,
                Json* where, PackedArrays* arrays) {
  Json packed = Json::object();
  for (const NodeField& field : fields) {
    (*about)[field.name] = {{"title", field.title}, {"top", field.top}};
    (*where)[field.name] = arrays->Add(field.values, nodes);
    packed[field.name] = {{"frames", PlacesOf(field.frames, frames, name)},
                          {"holds", field.holds},
                          {"unit", NodeField::kUnit},
                          {"top", field.top}};
  }
  return packed;
}

/// A surface as the viewer reads it. `curves`: its own.
Json SurfaceOf(const RecordedSurface& recorded, const SurfaceCurves& curves,
               const std::vector<int>& frames,
               const std::vector<NodeField>& fields, Json* about,
               PackedArrays* arrays) {
  SceneSurface surface{
      recorded, SimplifiedMesh(recorded.mesh, kVertices), {}, {}};
  surface.skinning = SkinningIndex(recorded.graph, recorded.neighbors_per_point)
                         .Skin(surface.smaller.mesh.vertices);
  std::vector<int> own;
  for (const FrameMotions& motions : recorded.motions.frames) {
    own.push_back(motions.frame);
  }
  surface.places = PlacesOf(own, frames, curves.name);
  const int per_vertex =
      std::min(recorded.graph.size(), recorded.neighbors_per_point);
  Json where = ArraysOf(surface, frames, per_vertex, arrays);
  const Json packed = PackFields(fields, curves.name, frames,
                                 recorded.graph.size(), about, &where, arrays);
  return {{"name", curves.name},
          {"states", curves.states},
          {"unit", kUnit},
          {"rotation_unit", kRotationUnit},
          {"stretched", kStretchedEdge},
          {"per_vertex", per_vertex},
          {"nodes", recorded.graph.size()},
          {"frames", surface.places},
          {"fields", packed},
          {"arrays", where}};
}

/// Poses of the camera by frame.
Json PosesOf(const RunPaths& paths, std::size_t frames) {
  const Trajectory trajectory = ReadTumTrajectory(paths.Trajectory());
  if (trajectory.size() != frames) {
    throw InputError(paths.Trajectory() + ": has " +
                     std::to_string(trajectory.size()) +
                     " poses: expected one for each frame of frames.jsonl, " +
                     std::to_string(frames));
  }
  Json poses = Json::array();
  for (const TimedPose& pose : trajectory) {
    const Eigen::Vector3d place = pose.world_from_camera.translation();
    const Eigen::Quaterniond turn(pose.world_from_camera.linear());
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

RunScene SceneOfRun(const RunPaths& paths, const RunCurves& curves) {
  PackedArrays arrays;
  Json surfaces = Json::array(), fields = Json::object();
  for (const SurfaceCurves& surface : curves.surfaces) {
    const RecordedSurface recorded =
        ReadRecordedSurface(paths.root() + "/surfaces/" + surface.name);
    surfaces.push_back(SurfaceOf(recorded, surface, curves.frames,
                                 FieldsOf(paths, recorded), &fields, &arrays));
  }
  RunScene scene;
  scene.header = {{"frames", curves.frames},
                  {"poses", PosesOf(paths, curves.frames.size())},
                  {"fov", FieldOfView(paths)},
                  {"fields", fields},
                  {"surfaces", surfaces}};
  scene.arrays = arrays.Text();
  return scene;
}

}  // namespace splitfusion
