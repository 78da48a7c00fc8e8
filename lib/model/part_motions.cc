#include "splitfusion/lib/model/part_motions.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace splitfusion {
namespace {

/// Nodes and frames of a part.
ModelPart PartAt(const DeformationGraph& graph, std::size_t index) {
  return graph.parts.empty() ? ModelPart() : graph.parts[index];
}

/// Index of the node behind the last one of a part.
int EndNode(const DeformationGraph& graph, std::size_t index) {
  return index + 1 < graph.parts.size() ? graph.parts[index + 1].node
                                        : graph.size();
}

PartMotions MotionsInWorld(const SurfaceModel& model, std::size_t index,
                           const std::vector<Eigen::Vector3d>& centers,
                           const std::map<int, Rigid3d>& world_from_camera) {
  const DeformationGraph& graph = model.graph;
  const ModelPart part = PartAt(graph, index);
  PartMotions motions;
  motions.first_node = part.node;
  const int end = EndNode(graph, index);
  for (int i = part.node; i < end; ++i) {
    motions.rest.push_back(centers[i]);
    motions.neighbors.push_back(graph.neighbors[i]);
    for (int& j : motions.neighbors.back()) j -= part.node;
  }
  for (const FrameMotions& frame : model.history.frames) {
    if (frame.frame < part.first_frame || frame.frame >= part.end_frame) {
      continue;
    }
    const Rigid3d& pose = world_from_camera.at(frame.frame);
    motions.indices.push_back(frame.frame);
    auto& states = motions.states.emplace_back();
    const int ahead = part.node - frame.IndexOf(part.node);
    for (int i = part.node; i < end; ++i) {
      const NodeMotion& motion = frame.motions[i - ahead];
      states.push_back(
          {pose * ApplyNode(graph.positions[i], motion, centers[i]),
           pose.linear() * motion.rotation, !frame.Saw(i)});
    }
  }
  return motions;
}

/// Before the first and after the last frame in which anything of the part was
/// seen nothing is sought.
void LeaveEndsAlone(PartMotions* motions) {
  const auto sees = [](const std::vector<PartMotions::State>& states) {
    return std::any_of(states.begin(), states.end(),
                       [](const PartMotions::State& s) { return !s.hidden; });
  };
  const auto leave = [&](auto begin, auto end) {
    for (auto frame = begin; frame != end; ++frame) {
      if (sees(*frame)) return;
      for (PartMotions::State& state : *frame) state.hidden = false;
    }
  };
  // Of a part that was never seen the first pass leaves nothing to seek.
  leave(motions->states.begin(), motions->states.end());
  leave(motions->states.rbegin(), motions->states.rend());
}

/// Before its first and after its last sight a node stays where tracking had
/// it, beside what was seen of the part; where nothing was, it goes with that.
void LeaveOneSided(PartMotions* motions) {
  std::vector<int> first(motions->nodes(), motions->frames());
  std::vector<int> last(motions->nodes(), -1);
  std::vector<char> sees(motions->frames(), false);
  for (int f = 0; f < motions->frames(); ++f) {
    for (int i = 0; i < motions->nodes(); ++i) {
      if (motions->states[f][i].hidden) continue;
      first[i] = std::min(first[i], f);
      last[i] = f;
      sees[f] = true;
    }
  }
  for (int f = 0; f < motions->frames(); ++f) {
    for (int i = 0; i < motions->nodes(); ++i) {
      if (sees[f] != 0 && (f < first[i] || f > last[i])) {
        motions->states[f][i].hidden = false;
      }
    }
  }
}

/// Spreads the way and the turn with which a node comes into sight again over
/// the frames in which it was hidden: where its motion begins to be sought, and
/// where it is taken to be beyond a window.
void SpreadReturns(PartMotions* motions) {
  for (int i = 0; i < motions->nodes(); ++i) {
    int last = -1;  // In which it was known.
    for (int f = 0; f < motions->frames(); ++f) {
      const PartMotions::State& now = motions->states[f][i];
      if (now.hidden) continue;
      if (last >= 0 && f > last + 1) {
        const PartMotions::State& before = motions->states[f - 1][i];
        const Eigen::Vector3d way = now.place - before.place;
        const Eigen::AngleAxisd turn(now.rotation *
                                     before.rotation.transpose());
        const double span = motions->indices[f] - motions->indices[last];
        for (int k = last + 1; k < f; ++k) {
          const double share =
              (motions->indices[k] - motions->indices[last]) / span;
          PartMotions::State& state = motions->states[k][i];
          state.place += share * way;
          state.rotation =
              Eigen::AngleAxisd(share * turn.angle(), turn.axis()) *
              state.rotation;
        }
      }
      last = f;
    }
  }
}

}  // namespace

bool PartMotions::HasHidden() const {
  for (const std::vector<State>& frame : states) {
    for (const State& state : frame) {
      if (state.hidden) return true;
    }
  }
  return false;
}

std::vector<Eigen::Vector3d> CentersOf(const SurfaceModel& model) {
  std::vector<Eigen::Vector3d> centers = model.graph.positions;
  if (!model.graph.rigid() || model.mesh.vertices.empty()) return centers;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& v : model.mesh.vertices) sum += v.cast<double>();
  centers[0] = sum / static_cast<double>(model.mesh.vertices.size());
  return centers;
}

PartMotions MotionsOfPart(const SurfaceModel& model, std::size_t part,
                          const std::vector<Eigen::Vector3d>& centers,
                          const std::map<int, Rigid3d>& world_from_camera) {
  PartMotions motions = MotionsInWorld(model, part, centers, world_from_camera);
  LeaveOneSided(&motions);
  LeaveEndsAlone(&motions);
  SpreadReturns(&motions);
  return motions;
}

void StoreMotions(const PartMotions& motions,
                  const std::map<int, Rigid3d>& world_from_camera,
                  SurfaceModel* model) {
  std::size_t f = 0;
  for (FrameMotions& frame : model->history.frames) {
    if (f == motions.indices.size() || frame.frame != motions.indices[f]) {
      continue;
    }
    const Rigid3d camera_from_world =
        world_from_camera.at(frame.frame).inverse();
    const int first = frame.IndexOf(motions.first_node);
    for (int i = 0; i < motions.nodes(); ++i) {
      const PartMotions::State& state = motions.states[f][i];
      if (!state.hidden) continue;
      const Eigen::Vector3d& g = model->graph.positions[motions.first_node + i];
      NodeMotion& motion = frame.motions[first + i];
      motion.rotation =
          Orthonormalized(camera_from_world.linear() * state.rotation);
      motion.translation = camera_from_world * state.place - g -
                           motion.rotation * (motions.rest[i] - g);
    }
    ++f;
  }
}

std::vector<char> WhichWereRefuted(const DeformationGraph& graph) {
  std::vector<char> refuted(graph.parts.size());
  int earliest = ModelPart::kNoEnd;  // First frame of the parts that follow.
  for (std::size_t i = graph.parts.size(); i-- > 0;) {
    refuted[i] = earliest < graph.parts[i].end_frame;
    earliest = std::min(earliest, graph.parts[i].first_frame);
  }
  return refuted;
}

}  // namespace splitfusion
