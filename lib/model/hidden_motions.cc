#include "splitfusion/lib/model/hidden_motions.h"

#include <tbb/parallel_for.h>

#include <Eigen/CholmodSupport>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace splitfusion {
namespace {

using Places = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// One part of a surface through the frames in which it is in use, in the
/// world.
struct PartMotions {
  /// What is known of a node in a frame.
  struct State {
    Eigen::Vector3d place;     // Of its centre, metres.
    Eigen::Matrix3d rotation;  // World from canonical.
    bool hidden = false;       // Whether its motion is sought.
  };

  int frames() const { return static_cast<int>(states.size()); }
  int nodes() const { return static_cast<int>(rest.size()); }

  int first_node = 0;
  std::vector<Eigen::Vector3d> rest;        // Places, canonical.
  std::vector<std::vector<int>> neighbors;  // By their number in the part.
  std::vector<int> indices;                 // Of the frames.
  std::vector<std::vector<State>> states;   // By frame, then node.
};

/// Where the centre of a node is: that of a rigid surface amid its mesh.
std::vector<Eigen::Vector3d> CentersOf(const SurfaceModel& model) {
  std::vector<Eigen::Vector3d> centers = model.graph.positions;
  if (!model.graph.rigid() || model.mesh.vertices.empty()) return centers;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& v : model.mesh.vertices) sum += v.cast<double>();
  centers[0] = sum / static_cast<double>(model.mesh.vertices.size());
  return centers;
}

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
    for (int i = part.node; i < end; ++i) {
      const NodeMotion& motion = frame.motions[i];
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

/// Weights of three places whose sum is the second difference in time, at the
/// middle one; 1, -2, 1 of frames that follow one another.
std::array<double, 3> SecondDifference(int before, int at, int after) {
  const double a = at - before, b = after - at;
  return {2 / (a * (a + b)), -2 / (a * b), 2 / (b * (a + b))};
}

/// Frames [begin, end) of a part, whose hidden nodes are sought; what is hidden
/// before them was found.
class Window {
 public:
  Window(PartMotions* motions, int begin, int end, double smoothness)
      : motions_(*motions),
        begin_(begin),
        end_(end),
        smoothness_(smoothness),
        numbers_(end - begin, std::vector<int>(motions->nodes(), -1)) {
    for (int f = begin; f < end; ++f) {
      for (int i = 0; i < motions_.nodes(); ++i) {
        if (motions_.states[f][i].hidden) numbers_[f - begin][i] = unknowns_++;
      }
    }
  }

  int unknowns() const { return unknowns_; }

  /// Those before a frame.
  int UnknownsBefore(int frame) const {
    int count = 0;
    for (int f = begin_; f < std::min(frame, end_); ++f) {
      for (int i = 0; i < motions_.nodes(); ++i) count += Number(f, i) >= 0;
    }
    return count;
  }

  /// Leaves its motions as they were.
  void GiveUp() {
    ForEachUnknown([](int /*number*/, PartMotions::State& state) {
      state.hidden = false;
    });
  }

  /// Factorises the matrix of the places; false if that fails.
  bool Factorize() {
    std::vector<Eigen::Triplet<double>> entries;
    start_.resize(unknowns_, 3);
    ForEachUnknown([&](int number, const PartMotions::State& state) {
      entries.emplace_back(number, number, kStay);
      start_.row(number) = state.place;
    });
    ForEachEdge([&](int f, int i, int j) {
      const std::array<int, 2> number = {Number(f, i), Number(f, j)};
      AddProducts(number, {1, -1}, 1, &entries);
    });
    ForEachDifference([&](int f, int i, const std::array<double, 3>& weights) {
      AddProducts(NumbersAt(f, i), weights, smoothness_, &entries);
    });
    Eigen::SparseMatrix<double> matrix(unknowns_, unknowns_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    // METIS draws random numbers of the whole process.
    cholesky_.cholmod().nmethods = 1;
    cholesky_.cholmod().method[0].ordering = CHOLMOD_AMD;
    cholesky_.cholmod().print = 0;
    cholesky_.compute(matrix);
    return cholesky_.info() == Eigen::Success;
  }

  /// Places for the rotations of now; the longest way of one, metres.
  double FindPlaces() {
    Places right = kStay * start_;
    ForEachEdge([&](int f, int i, int j) {
      const std::array<int, 2> number = {Number(f, i), Number(f, j)};
      AddKnown(number, {1, -1}, 1, {Place(f, i), Place(f, j)},
               RestEdge(f, i, j), &right);
    });
    ForEachDifference([&](int f, int i, const std::array<double, 3>& weights) {
      AddKnown(NumbersAt(f, i), weights, smoothness_,
               {Place(f - 1, i), Place(f, i), Place(f + 1, i)},
               Eigen::Vector3d::Zero(), &right);
    });
    const Places found = cholesky_.solve(right);
    double longest = 0;
    ForEachUnknown([&](int number, PartMotions::State& state) {
      const Eigen::Vector3d place = found.row(number);
      longest = std::max(longest, (place - state.place).norm());
      state.place = place;
    });
    return longest;
  }

  /// Rotations for the places of now: of each node the one that fits its edges
  /// best, nearest to the one it had where they leave that open.
  void FindRotations() {
    for (int f = begin_; f < end_; ++f) {
      for (int i = 0; i < motions_.nodes(); ++i) {
        if (Number(f, i) < 0 || motions_.neighbors[i].empty()) continue;
        Eigen::Matrix3d& rotation = motions_.states[f][i].rotation;
        Eigen::Matrix3d sum = kStay * rotation.transpose();
        for (const int j : motions_.neighbors[i]) {
          sum += (motions_.rest[i] - motions_.rest[j]) *
                 (Place(f, i) - Place(f, j)).transpose();
        }
        const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
            sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
        Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
        sign(2, 2) =
            (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1
                                                                          : 1;
        rotation = svd.matrixV() * sign * svd.matrixU().transpose();
      }
    }
  }

  HiddenMotionCost Cost() const {
    HiddenMotionCost cost;
    ForEachEdge([&](int f, int i, int j) {
      cost.arap +=
          (Place(f, i) - Place(f, j) - RestEdge(f, i, j)).squaredNorm();
    });
    ForEachDifference([&](int f, int i, const std::array<double, 3>& weights) {
      cost.smoothness += smoothness_ * (weights[0] * Place(f - 1, i) +
                                        weights[1] * Place(f, i) +
                                        weights[2] * Place(f + 1, i))
                                           .squaredNorm();
    });
    return cost;
  }

 private:
  /// Weight with which a node stays where it was, of that of an edge: where
  /// nothing else holds it.
  static constexpr double kStay = 1e-6;  // Maths.

  /// -1: known.
  int Number(int frame, int node) const {
    return frame < begin_ || frame >= end_ ? -1
                                           : numbers_[frame - begin_][node];
  }

  std::array<int, 3> NumbersAt(int frame, int node) const {
    return {Number(frame - 1, node), Number(frame, node),
            Number(frame + 1, node)};
  }

  const Eigen::Vector3d& Place(int frame, int node) const {
    return motions_.states[frame][node].place;
  }

  Eigen::Vector3d RestEdge(int frame, int i, int j) const {
    return motions_.states[frame][i].rotation *
           (motions_.rest[i] - motions_.rest[j]);
  }

  template <typename Visit>
  void ForEachUnknown(const Visit& visit) {
    for (int f = begin_; f < end_; ++f) {
      for (int i = 0; i < motions_.nodes(); ++i) {
        if (Number(f, i) >= 0) visit(Number(f, i), motions_.states[f][i]);
      }
    }
  }

  /// Edges (i, j) of which an end is sought.
  template <typename Visit>
  void ForEachEdge(const Visit& visit) const {
    for (int f = begin_; f < end_; ++f) {
      for (int i = 0; i < motions_.nodes(); ++i) {
        for (const int j : motions_.neighbors[i]) {
          if (Number(f, i) >= 0 || Number(f, j) >= 0) visit(f, i, j);
        }
      }
    }
  }

  /// Second differences in time at frame f with a place that is sought; what
  /// lies behind the window is taken for known.
  template <typename Visit>
  void ForEachDifference(const Visit& visit) const {
    for (int f = std::max(1, begin_ - 1);
         f <= end_ && f + 1 < motions_.frames(); ++f) {
      const std::array<double, 3> weights =
          SecondDifference(motions_.indices[f - 1], motions_.indices[f],
                           motions_.indices[f + 1]);
      for (int i = 0; i < motions_.nodes(); ++i) {
        const std::array<int, 3> numbers = NumbersAt(f, i);
        if (std::any_of(numbers.begin(), numbers.end(),
                        [](int number) { return number >= 0; })) {
          visit(f, i, weights);
        }
      }
    }
  }

  /// What |sum of weights x places|^2 adds to the matrix.
  template <std::size_t N>
  static void AddProducts(const std::array<int, N>& numbers,
                          const std::array<double, N>& weights, double weight,
                          std::vector<Eigen::Triplet<double>>* entries) {
    for (std::size_t a = 0; a < N; ++a) {
      for (std::size_t b = 0; b < N; ++b) {
        if (numbers[a] < 0 || numbers[b] < 0) continue;
        entries->emplace_back(numbers[a], numbers[b],
                              weight * weights[a] * weights[b]);
      }
    }
  }

  /// What |sum of weights x places - rest|^2 adds to the right side.
  template <std::size_t N>
  static void AddKnown(const std::array<int, N>& numbers,
                       const std::array<double, N>& weights, double weight,
                       const std::array<Eigen::Vector3d, N>& places,
                       const Eigen::Vector3d& rest, Places* right) {
    Eigen::Vector3d known = rest;
    for (std::size_t a = 0; a < N; ++a) {
      if (numbers[a] < 0) known -= weights[a] * places[a];
    }
    for (std::size_t a = 0; a < N; ++a) {
      if (numbers[a] >= 0) {
        right->row(numbers[a]) += weight * weights[a] * known.transpose();
      }
    }
  }

  PartMotions& motions_;
  int begin_, end_;
  double smoothness_;
  int unknowns_ = 0;
  std::vector<std::vector<int>> numbers_;  // By frame, then node.
  Places start_;
  // Not the supernodal one, whose sums depend on the number of threads.
  Eigen::CholmodSimplicialLLT<Eigen::SparseMatrix<double>> cholesky_;
};

/// Finds what is hidden in frames [begin, end); kept is what is before `kept`.
RefinedWindow Refine(int begin, int end, int kept,
                     const HiddenMotionOptions& options, PartMotions* motions) {
  constexpr int kMaxIterations = 10;  // Speed: 30 move nothing more.
  constexpr double kSettled = 1e-4;   // Maths. Metres.
  Window window(motions, begin, end, options.smoothness);
  RefinedWindow report;
  report.first_frame = motions->indices[begin];
  report.last_frame = motions->indices[end - 1];
  report.hidden = window.unknowns();
  report.kept = window.UnknownsBefore(kept);
  if (report.hidden == 0) return report;
  report.initial = window.Cost();
  report.solved = window.Factorize();
  if (report.solved) {
    double way = 0;
    do {
      way = window.FindPlaces();
      window.FindRotations();
    } while (++report.iterations < kMaxIterations && way > kSettled);
  } else {
    window.GiveUp();
  }
  report.final = window.Cost();
  return report;
}

/// One window after the other; what half of them found is kept.
std::vector<RefinedWindow> RefinePart(const HiddenMotionOptions& options,
                                      PartMotions* motions) {
  std::vector<RefinedWindow> windows;
  for (int begin = 0; begin < motions->frames();) {
    const int end = std::min(begin + options.window, motions->frames());
    const bool is_last = end == motions->frames();
    const int kept = is_last ? end : begin + options.window / 2;
    const RefinedWindow window = Refine(begin, end, kept, options, motions);
    if (window.hidden > 0) windows.push_back(window);
    if (is_last) break;
    begin = kept;
  }
  return windows;
}

/// Puts what was found into the history; the other nodes keep their bits.
void Store(const PartMotions& motions,
           const std::map<int, Rigid3d>& world_from_camera,
           SurfaceModel* model) {
  std::size_t f = 0;
  for (FrameMotions& frame : model->history.frames) {
    if (f == motions.indices.size() || frame.frame != motions.indices[f]) {
      continue;
    }
    const Rigid3d camera_from_world =
        world_from_camera.at(frame.frame).inverse();
    for (int i = 0; i < motions.nodes(); ++i) {
      const PartMotions::State& state = motions.states[f][i];
      if (!state.hidden) continue;
      const int node = motions.first_node + i;
      const Eigen::Vector3d& g = model->graph.positions[node];
      NodeMotion& motion = frame.motions[node];
      motion.rotation =
          Orthonormalized(camera_from_world.linear() * state.rotation);
      motion.translation = camera_from_world * state.place - g -
                           motion.rotation * (motions.rest[i] - g);
    }
    ++f;
  }
}

}  // namespace

void HiddenMotionOptions::List(OptionList* list) {
  list->Switch("refine", &refine,
               "Once all frames are known, find the motions of what was hidden "
               "between its last and its next sight.");
  list->Number(
      "refine_smoothness", &smoothness, Range::Above(0), "",
      "Weight of smoothness in time of what was hidden, of that of its "
      "shape.");
  list->Number("refine_window", &window, Range::AtLeast(4), "frames",
               "Frames of which the motions are found together.");
}

std::vector<RefinedWindow> RefineHiddenMotions(
    const std::map<int, Rigid3d>& world_from_camera,
    const HiddenMotionOptions& options, SurfaceModel* model) {
  const std::size_t parts = std::max<std::size_t>(1, model->graph.parts.size());
  const std::vector<Eigen::Vector3d> centers = CentersOf(*model);
  std::vector<std::vector<RefinedWindow>> windows(parts);
  tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t index) {
    PartMotions motions =
        MotionsInWorld(*model, index, centers, world_from_camera);
    LeaveEndsAlone(&motions);
    LeaveOneSided(&motions);
    SpreadReturns(&motions);
    windows[index] = RefinePart(options, &motions);
    Store(motions, world_from_camera, model);
  });
  std::vector<RefinedWindow> all;
  for (std::size_t index = 0; index < parts; ++index) {
    for (RefinedWindow& window : windows[index]) {
      window.part = static_cast<int>(index);
      all.push_back(window);
    }
  }
  return all;
}

}  // namespace splitfusion
