#include "splitfusion/lib/model/surface_model.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "splitfusion/lib/base/chosen.h"

namespace splitfusion {
namespace {

/// Between canonical frames, metres; more than a node reaches.
constexpr double kGap = 1;  // Layout.

/// Extent along x of a model's nodes and vertices, metres.
struct Extent {
  explicit Extent(const SurfaceModel& model) {
    for (const Eigen::Vector3d& g : model.graph.positions) Add(g.x());
    for (const Eigen::Vector3f& v : model.mesh.vertices) Add(v.x());
  }

  void Add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }

  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

void AppendMesh(const TriangleMesh& mesh, double shift, TriangleMesh* joined) {
  const int first = static_cast<int>(joined->vertices.size());
  for (const Eigen::Vector3f& v : mesh.vertices) {
    joined->vertices.push_back(
        v + Eigen::Vector3f(static_cast<float>(shift), 0, 0));
  }
  joined->normals.insert(joined->normals.end(), mesh.normals.begin(),
                         mesh.normals.end());
  joined->colors.insert(joined->colors.end(), mesh.colors.begin(),
                        mesh.colors.end());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    joined->triangles.push_back(t + Eigen::Vector3i::Constant(first));
  }
}

void AppendGraph(const SurfaceModel& model, double shift,
                 DeformationGraph* joined) {
  const DeformationGraph& graph = model.graph;
  const int first_node = joined->size();
  const int first_frame = model.history.frames.front().frame;
  joined->parts.push_back(
      {first_node, first_frame, model.history.frames.back().frame + 1});
  joined->node_spacing = std::max(joined->node_spacing, graph.node_spacing);
  for (int i = 0; i < graph.size(); ++i) {
    joined->positions.push_back(graph.positions[i] +
                                Eigen::Vector3d(shift, 0, 0));
    joined->neighbors.push_back(graph.neighbors[i]);
    for (int& j : joined->neighbors.back()) j += first_node;
    const bool known = i < static_cast<int>(graph.first_seen.size());
    joined->first_seen.push_back(known ? graph.first_seen[i] : first_frame);
  }
}

/// Takes the motions of a model in a frame of its own, behind those of the
/// parts before: its nodes begin at `first` and were moved by `shift` along x.
void AppendMotions(const FrameMotions& own, int first, double shift,
                   FrameMotions* all) {
  const int count = static_cast<int>(own.motions.size());
  if (!all->ranges.empty() && all->ranges.back().end == first) {
    all->ranges.back().end += count;
  } else {
    all->ranges.push_back({first, first + count});
  }
  for (NodeMotion motion : own.motions) {
    motion.translation.x() -= shift;
    all->motions.push_back(motion);
  }
  all->seen.insert(all->seen.end(), own.seen.begin(), own.seen.end());
  all->seen.resize(all->motions.size(), false);
}

/// All frames of some models, and whether the surface was tracked in them.
std::map<int, bool> FramesOf(const std::vector<SurfaceModel>& models) {
  std::map<int, bool> frames;
  for (const SurfaceModel& model : models) {
    for (const FrameMotions& frame : model.history.frames) {
      frames[frame.frame] = frame.tracked;
    }
  }
  return frames;
}

/// The triangles that have a vertex whose nearest node is one of `of_nodes`,
/// and those beside them; their vertices; the nearest nodes of these, and all
/// nodes within two edges of them, among which SkinningIndex chooses.
struct PartMembers {
  PartMembers(const TriangleMesh& mesh,
              const std::vector<SkinningSupport>& supports,
              const DeformationGraph& graph, const std::vector<char>& of_nodes)
      : vertices(mesh.vertices.size()), nearest(graph.size(), false) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      vertices[i] = of_nodes[supports[i].nearest];
    }
    vertices = VerticesBeside(mesh, vertices);
    for (const Eigen::Vector3i& t : mesh.triangles) {
      if (vertices[t[0]] || vertices[t[1]] || vertices[t[2]]) {
        triangles.push_back(t);
      }
    }
    vertices = VerticesBeside(mesh, vertices);
    for (const Eigen::Vector3i& t : triangles) {
      for (int k = 0; k < 3; ++k) nearest[supports[t[k]].nearest] = true;
    }
    nodes = nearest;
    for (int edges = 0; edges < 2; ++edges) {
      const std::vector<char> reached = nodes;
      for (int i = 0; i < graph.size(); ++i) {
        if (reached[i] == 0) continue;
        for (const int j : graph.neighbors[i]) nodes[j] = true;
      }
    }
  }

  /// The vertices of all triangles that have one of `some`.
  static std::vector<char> VerticesBeside(const TriangleMesh& mesh,
                                          const std::vector<char>& some) {
    std::vector<char> beside(some.size(), false);
    for (const Eigen::Vector3i& t : mesh.triangles) {
      if (!some[t[0]] && !some[t[1]] && !some[t[2]]) continue;
      for (int k = 0; k < 3; ++k) beside[t[k]] = true;
    }
    return beside;
  }

  std::vector<Eigen::Vector3i> triangles;
  std::vector<char> vertices;  // Of every one whether it is a member.
  std::vector<char> nearest;   // As `vertices`, of nodes.
  std::vector<char> nodes;     // As `nearest`.
};

/// The first frame in which anything was seen that some nodes carry; of all
/// frames, where that is not recorded.
int FirstSight(const DeformationGraph& graph, const std::vector<char>& nodes) {
  int first = std::numeric_limits<int>::max();
  for (int i = 0; i < graph.size(); ++i) {
    if (nodes[i] == 0) continue;
    const bool known = i < static_cast<int>(graph.first_seen.size());
    first = std::min(first, known ? graph.first_seen[i] : 0);
  }
  return first;
}

/// Numbers of the members among themselves; -1: no member.
std::vector<int> Numbers(const std::vector<char>& members) {
  std::vector<int> numbers(members.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i] != 0) numbers[i] = count++;
  }
  return numbers;
}

DeformationGraph GraphOf(const DeformationGraph& graph,
                         const std::vector<char>& members) {
  DeformationGraph part;
  part.positions = Chosen(graph.positions, members);
  part.motions = Chosen(graph.motions, members);
  part.neighbors = Chosen(graph.neighbors, members);
  part.first_seen = Chosen(graph.first_seen, members);
  part.node_spacing = graph.node_spacing;
  const std::vector<int> numbers = Numbers(members);
  for (std::vector<int>& edges : part.neighbors) {
    std::vector<int> kept;
    for (const int j : edges) {
      if (numbers[j] >= 0) kept.push_back(numbers[j]);
    }
    edges = std::move(kept);
  }
  return part;
}

}  // namespace

SurfacePart PartOf(const TriangleMesh& mesh,
                   const std::vector<SkinningSupport>& supports,
                   const DeformationGraph& graph,
                   const std::vector<char>& of_nodes) {
  PartMembers members(mesh, supports, graph, of_nodes);
  SurfacePart part;
  part.mesh.vertices = Chosen(mesh.vertices, members.vertices);
  part.mesh.normals = Chosen(mesh.normals, members.vertices);
  part.mesh.colors = Chosen(mesh.colors, members.vertices);
  const std::vector<int> numbers = Numbers(members.vertices);
  for (const Eigen::Vector3i& t : members.triangles) {
    part.mesh.triangles.emplace_back(numbers[t[0]], numbers[t[1]],
                                     numbers[t[2]]);
  }
  part.graph = GraphOf(graph, members.nodes);
  part.first_frame = FirstSight(graph, members.nearest);
  part.nodes = std::move(members.nodes);
  return part;
}

SurfaceModel JoinModels(std::vector<SurfaceModel> models) {
  if (models.size() == 1) return std::move(models.front());
  SurfaceModel joined;
  std::vector<double> shifts;
  double end = 0;
  for (const SurfaceModel& model : models) {
    const Extent extent(model);
    shifts.push_back(shifts.empty() ? 0 : end + kGap - extent.low);
    end = extent.high + shifts.back();
    AppendMesh(model.mesh, shifts.back(), &joined.mesh);
    AppendGraph(model, shifts.back(), &joined.graph);
  }
  joined.graph.parts.back().end_frame = ModelPart::kNoEnd;
  joined.graph.motions.resize(joined.graph.size());
  for (const auto& [index, tracked] : FramesOf(models)) {
    FrameMotions all{index, tracked, {}, {}, {}};
    for (std::size_t i = 0; i < models.size(); ++i) {
      const FrameMotions* own = models[i].history.Find(index);
      if (own == nullptr) continue;
      AppendMotions(*own, joined.graph.parts[i].node, shifts[i], &all);
    }
    all.SpreadTo(&joined.graph.motions);
    joined.history.frames.push_back(std::move(all));
  }
  return joined;
}

}  // namespace splitfusion
