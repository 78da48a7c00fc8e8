#include "splitfusion/lib/model/part_motions.h"

#include <algorithm>
#include <utility>

namespace splitfusion {
namespace {

/// Nodes and frames of a part.
ModelPart PartAt(const DeformationGraph& graph, std::size_t index) {
  return graph.parts.empty() ? ModelPart() : graph.parts[index];
}

/// A part with all that was not seen for hidden.
PartMotions SightsOf(const SurfaceModel& model, std::size_t index,
                     const std::vector<Eigen::Vector3d>& centers) {
  const DeformationGraph& graph = model.graph;
  const ModelPart part = PartAt(graph, index);
  PartMotions motions;
  motions.part = static_cast<int>(index);
  motions.first_node = part.node;
  const int end = graph.EndOfPart(index);
  for (int i = part.node; i < end; ++i) {
    motions.rest.push_back(centers[i]);
    motions.neighbors.push_back(graph.neighbors[i]);
    for (int& j : motions.neighbors.back()) j -= part.node;
  }
  for (int f = 0; f < model.history.size(); ++f) {
    const int number = model.history.frame(f);
    if (number < part.first_frame || number >= part.end_frame) continue;
    const FrameMotions frame = model.history.At(f);
    motions.indices.push_back(number);
    auto& hidden = motions.hidden.emplace_back();
    for (int i = part.node; i < end; ++i) hidden.push_back(!frame.Saw(i));
  }
  motions.states.resize(motions.indices.size());
  return motions;
}

/// Before the first and after the last frame in which anything of the part was
/// seen nothing is sought.
void LeaveEndsAlone(PartMotions* motions) {
  const auto leave = [&](auto begin, auto end) {
    for (auto frame = begin; frame != end; ++frame) {
      if (std::count(frame->begin(), frame->end(), false) > 0) return;
      std::fill(frame->begin(), frame->end(), false);
    }
  };
  // Of a part that was never seen the first pass leaves nothing to seek.
  leave(motions->hidden.begin(), motions->hidden.end());
  leave(motions->hidden.rbegin(), motions->hidden.rend());
}

/// Before its first and after its last sight a node stays where tracking had
/// it, beside what was seen of the part; where nothing was, it goes with that.
void LeaveOneSided(PartMotions* motions) {
  std::vector<int> first(motions->nodes(), motions->frames());
  std::vector<int> last(motions->nodes(), -1);
  std::vector<char> sees(motions->frames(), false);
  for (int f = 0; f < motions->frames(); ++f) {
    for (int i = 0; i < motions->nodes(); ++i) {
      if (motions->hidden[f][i] != 0) continue;
      first[i] = std::min(first[i], f);
      last[i] = f;
      sees[f] = true;
    }
  }
  for (int f = 0; f < motions->frames(); ++f) {
    for (int i = 0; i < motions->nodes(); ++i) {
      if (sees[f] != 0 && (f < first[i] || f > last[i])) {
        motions->hidden[f][i] = false;
      }
    }
  }
}

}  // namespace

bool PartMotions::HasHidden(int begin, int end) const {
  return std::any_of(hidden.begin() + begin, hidden.begin() + end,
                     [](const std::vector<char>& frame) {
                       return std::count(frame.begin(), frame.end(), true) > 0;
                     });
}

std::vector<Eigen::Vector3d> CentersOf(const SurfaceModel& model) {
  std::vector<Eigen::Vector3d> centers = model.graph.positions;
  if (!model.graph.rigid() || model.mesh.vertices.empty()) return centers;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& v : model.mesh.vertices) sum += v.cast<double>();
  centers[0] = sum / static_cast<double>(model.mesh.vertices.size());
  return centers;
}

PartFrames::PartFrames(std::size_t part,
                       const std::vector<Eigen::Vector3d>& centers,
                       const std::map<int, Rigid3d>& world_from_camera,
                       const SurfaceModel& model)
    : centers_(centers),
      world_from_camera_(world_from_camera),
      model_(model),
      motions_(SightsOf(model, part, centers)) {
  LeaveOneSided(&motions_);
  LeaveEndsAlone(&motions_);
  if (motions_.HasHidden(0, motions_.frames())) FindStretches();
}

/// As tracking had it.
std::vector<PartMotions::State> PartFrames::Tracked(int f) const {
  const FrameMotions frame = *model_.history.Find(motions_.indices[f]);
  const Rigid3d& pose = world_from_camera_.at(frame.frame);
  const int begin = motions_.first_node;
  const int first = frame.IndexOf(begin);
  std::vector<PartMotions::State> states;
  states.reserve(motions_.nodes());
  for (int i = 0; i < motions_.nodes(); ++i) {
    const NodeMotion& motion = frame.motions[first + i];
    states.push_back({pose * ApplyNode(model_.graph.positions[begin + i],
                                       motion, centers_[begin + i]),
                      pose.linear() * motion.rotation});
  }
  return states;
}

/// In a frame in which a node comes into sight again, it may be off: how far,
/// beside where it was tracked in the frame before.
void PartFrames::FindStretches() {
  stretches_.resize(motions_.nodes());
  std::vector<int> last(motions_.nodes(), -1);  // In which it was known.
  std::vector<PartMotions::State> before, now;
  for (int f = 0; f < motions_.frames(); ++f) {
    now = Tracked(f);
    for (int i = 0; i < motions_.nodes(); ++i) {
      if (motions_.hidden[f][i] != 0) continue;
      if (last[i] >= 0 && f > last[i] + 1) {
        const Eigen::AngleAxisd turn(now[i].rotation *
                                     before[i].rotation.transpose());
        stretches_[i].push_back(
            {last[i], f, now[i].place - before[i].place, turn});
      }
      last[i] = f;
    }
    before.swap(now);
  }
}

/// Takes the share of its return that falls to the time since it was known.
void PartFrames::Spread(int f, std::vector<PartMotions::State>* states) const {
  const std::vector<int>& indices = motions_.indices;
  for (int i = 0; i < motions_.nodes(); ++i) {
    if (motions_.hidden[f][i] == 0) continue;
    const std::vector<Stretch>& own = stretches_[i];
    const auto found =
        std::upper_bound(own.begin(), own.end(), f,
                         [](int at, const Stretch& s) { return at < s.next; });
    if (found == own.end() || f <= found->last) continue;
    const double span = indices[found->next] - indices[found->last];
    const double share = (indices[f] - indices[found->last]) / span;
    PartMotions::State& state = (*states)[i];
    state.place += share * found->way;
    state.rotation =
        Eigen::AngleAxisd(share * found->turn.angle(), found->turn.axis()) *
        state.rotation;
  }
}

void PartFrames::Load(int begin, int end, PartMotions* motions) const {
  for (int& f = motions->first_in_hand; f < begin; ++f) {
    motions->states[f] = std::vector<PartMotions::State>();
  }
  for (int f = begin; f < end; ++f) {
    if (!motions->states[f].empty()) continue;
    motions->states[f] = Tracked(f);
    Spread(f, &motions->states[f]);
  }
}

void StoreMotions(const PartMotions& motions, int begin, int end,
                  const std::map<int, Rigid3d>& world_from_camera,
                  SurfaceModel* model) {
  for (int f = begin; f < end; ++f) {
    if (!motions.HasHidden(f, f + 1)) continue;
    FrameMotions frame = *model->history.Find(motions.indices[f]);
    const Rigid3d camera_from_world =
        world_from_camera.at(frame.frame).inverse();
    const int first = frame.IndexOf(motions.first_node);
    for (int i = 0; i < motions.nodes(); ++i) {
      if (motions.hidden[f][i] == 0) continue;
      const PartMotions::State& state = motions.states[f][i];
      const Eigen::Vector3d& g = model->graph.positions[motions.first_node + i];
      NodeMotion& motion = frame.motions[first + i];
      motion.rotation =
          Orthonormalized(camera_from_world.linear() * state.rotation);
      motion.translation = camera_from_world * state.place - g -
                           motion.rotation * (motions.rest[i] - g);
    }
    model->history.Replace(std::move(frame));
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
