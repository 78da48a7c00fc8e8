#include "splitfusion/lib/model/hidden_window.h"

#include <tbb/parallel_for.h>

#include <Eigen/CholmodSupport>
#include <Eigen/SVD>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace splitfusion {
namespace {

using Places = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Weights of three places whose sum is the second difference in time, at the
/// middle one; 1, -2, 1 of frames that follow one another.
std::array<double, 3> SecondDifference(int before, int at, int after) {
  const double a = at - before, b = after - at;
  return {2 / (a * (a + b)), -2 / (a * b), 2 / (b * (a + b))};
}

/// Those of a place in frame f and in the frames beside it.
std::array<double, 3> DifferenceWeights(const PartMotions& motions, int f) {
  return SecondDifference(motions.indices[f - 1], motions.indices[f],
                          motions.indices[f + 1]);
}

/// The second difference in time of a node's place.
Eigen::Vector3d DifferenceInTime(const PartMotions& motions, int f, int i,
                                 const std::array<double, 3>& weights) {
  return weights[0] * motions.states[f - 1][i].place +
         weights[1] * motions.states[f][i].place +
         weights[2] * motions.states[f + 1][i].place;
}

/// An edge as its first end turns it, Eq. 6.
Eigen::Vector3d TurnedEdge(const PartMotions& motions, int f, int i, int j) {
  return motions.states[f][i].rotation * (motions.rest[i] - motions.rest[j]);
}

/// Frames [begin, end) of a part, whose hidden nodes are sought; what is hidden
/// before them was found.
class Window {
 public:
  Window(PartMotions* motions, int begin, int end, double smoothness,
         const ResidualNoise& noise)
      : motions_(*motions),
        begin_(begin),
        end_(end),
        smoothness_(smoothness),
        noise_(noise),
        numbers_(end - begin, std::vector<int>(motions->nodes(), -1)) {
    for (int f = begin; f < end; ++f) {
      for (int i = 0; i < motions_.nodes(); ++i) {
        if (motions_.hidden[f][i] != 0) numbers_[f - begin][i] = unknowns_++;
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
    for (int f = begin_; f < end_; ++f) {
      std::fill(motions_.hidden[f].begin(), motions_.hidden[f].end(), false);
    }
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
               EdgeTarget(f, i, j), &right);
    });
    ForEachDifference([&](int f, int i, const std::array<double, 3>& weights) {
      AddKnown(NumbersAt(f, i), weights, smoothness_,
               {Place(f - 1, i), Place(f, i), Place(f + 1, i)},
               DifferenceTarget(f, i), &right);
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
    tbb::parallel_for(begin_, end_, [&](int f) {
      for (int i = 0; i < motions_.nodes(); ++i) {
        if (Number(f, i) < 0 || motions_.neighbors[i].empty()) continue;
        Eigen::Matrix3d& rotation = motions_.states[f][i].rotation;
        rotation = FittingRotation(f, i, rotation);
      }
    });
  }

  /// Of the places and rotations of now.
  WindowProblem Problem() const {
    WindowProblem problem;
    problem.graph.positions.resize(unknowns_);
    problem.graph.motions.resize(unknowns_);
    problem.graph.neighbors.resize(unknowns_);
    for (int f = begin_; f < end_; ++f) {
      for (int i = 0; i < motions_.nodes(); ++i) {
        if (Number(f, i) < 0) continue;
        problem.graph.positions[Number(f, i)] = motions_.rest[i];
        problem.graph.motions[Number(f, i)] = MotionOf(f, i);
      }
    }
    std::map<std::pair<int, int>, int> known;
    const auto number = [&](int f, int i) {
      if (Number(f, i) >= 0) return Number(f, i);
      const int next = unknowns_ + static_cast<int>(known.size());
      const auto [found, is_new] = known.try_emplace({f, i}, next);
      if (is_new) {
        problem.links.known_positions.push_back(motions_.rest[i]);
        problem.links.known_motions.push_back(MotionOf(f, i));
      }
      return found->second;
    };
    ForEachEdge([&](int f, int i, int j) {
      problem.links.edges.push_back({number(f, i), number(f, j)});
    });
    ForEachDifference([&](int f, int i, const std::array<double, 3>& weights) {
      problem.links.triples.push_back(
          {number(f - 1, i), number(f, i), number(f + 1, i)});
      problem.links.differences.push_back(weights);
    });
    return problem;
  }

  HiddenMotionCost Cost() const {
    HiddenMotionCost cost;
    ForEachEdge([&](int f, int i, int j) {
      cost.arap +=
          (Place(f, i) - Place(f, j) - EdgeTarget(f, i, j)).squaredNorm();
    });
    ForEachDifference([&](int f, int i, const std::array<double, 3>& weights) {
      cost.smoothness +=
          smoothness_ *
          (DifferenceInTime(motions_, f, i, weights) - DifferenceTarget(f, i))
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

  /// World from canonical.
  NodeMotion MotionOf(int frame, int node) const {
    const PartMotions::State& state = motions_.states[frame][node];
    return {state.rotation, state.place - motions_.rest[node]};
  }

  const Eigen::Vector3d& Place(int frame, int node) const {
    return motions_.states[frame][node].place;
  }

  /// The one that fits the edges of a node best (Sorkine and Alexa 2007).
  Eigen::Matrix3d FittingRotation(int f, int i,
                                  const Eigen::Matrix3d& before) const {
    Eigen::Matrix3d sum = kStay * before.transpose();
    for (const int j : motions_.neighbors[i]) {
      sum += (motions_.rest[i] - motions_.rest[j]) *
             (Place(f, i) - Place(f, j) - EdgeNoise(f, i, j)).transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
        sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
    sign(2, 2) =
        (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1;
    return svd.matrixV() * sign * svd.matrixU().transpose();
  }

  Eigen::Vector3d EdgeNoise(int frame, int i, int j) const {
    return noise_.OfEdge(motions_.indices[frame], i, j);
  }

  /// What the difference of two places is to be.
  Eigen::Vector3d EdgeTarget(int frame, int i, int j) const {
    return TurnedEdge(motions_, frame, i, j) + EdgeNoise(frame, i, j);
  }

  /// What the second difference of a place in time is to be: none, but for the
  /// noise of its weighted residual.
  Eigen::Vector3d DifferenceTarget(int frame, int i) const {
    return noise_.OfDifference(motions_.indices[frame], i) /
           std::sqrt(smoothness_);
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
      const std::array<double, 3> weights = DifferenceWeights(motions_, f);
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
  ResidualNoise noise_;
  int unknowns_ = 0;
  std::vector<std::vector<int>> numbers_;  // By frame, then node.
  Places start_;
  // Not the supernodal one, whose sums depend on the number of threads.
  Eigen::CholmodSimplicialLLT<Eigen::SparseMatrix<double>> cholesky_;
};

/// Frames beside a window on which what is sought in it depends: of those of
/// second differences one end is in it.
constexpr int kBeside = 2;  // Maths.

/// Finds what is hidden in frames [begin, end), which is something; kept is
/// what is before `kept`.
RefinedWindow Refine(int begin, int end, int kept,
                     const HiddenMotionOptions& options,
                     const ResidualNoise& noise, const WindowHooks& hooks,
                     PartMotions* motions) {
  constexpr int kMaxIterations = 30;  // Speed: ten are seldom needed.
  constexpr double kSettled = 1e-4;   // Maths. Metres.
  Window window(motions, begin, end, options.smoothness, noise);
  RefinedWindow report;
  report.part = motions->part;
  report.first_frame = motions->indices[begin];
  report.last_frame = motions->indices[end - 1];
  report.hidden = window.unknowns();
  report.kept = window.UnknownsBefore(kept);
  report.initial = window.Cost();
  WindowProblem problem;
  if (hooks.solved) problem = window.Problem();
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
  if (hooks.solved) {
    problem.report = report;
    hooks.solved(problem);
  }
  return report;
}

}  // namespace

ResidualNoise NoiseOfSeen(double smoothness, const PartMotions& motions) {
  const auto& states = motions.states;
  const auto& hidden = motions.hidden;
  double edges = 0, differences = 0;
  std::int64_t edge_count = 0, difference_count = 0;
  for (int f = 0; f < motions.frames(); ++f) {
    for (int i = 0; i < motions.nodes(); ++i) {
      if (hidden[f][i] != 0) continue;
      for (const int j : motions.neighbors[i]) {
        if (hidden[f][j] != 0) continue;
        edges += (states[f][i].place - states[f][j].place -
                  TurnedEdge(motions, f, i, j))
                     .squaredNorm();
        edge_count += 3;
      }
      if (f == 0 || f + 1 == motions.frames()) continue;
      if (hidden[f - 1][i] != 0 || hidden[f + 1][i] != 0) continue;
      differences +=
          smoothness *
          DifferenceInTime(motions, f, i, DifferenceWeights(motions, f))
              .squaredNorm();
      difference_count += 3;
    }
  }
  const auto root_mean = [](double sum, std::int64_t count) {
    return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
  };
  return {root_mean(edges, edge_count),
          root_mean(differences, difference_count)};
}

std::vector<RefinedWindow> RefinePart(const HiddenMotionOptions& options,
                                      const ResidualNoise& noise,
                                      PartMotions* motions,
                                      const WindowHooks& hooks) {
  std::vector<RefinedWindow> windows;
  for (int begin = 0; begin < motions->frames();) {
    const int end = std::min(begin + options.window, motions->frames());
    const bool is_last = end == motions->frames();
    const int kept = is_last ? end : begin + options.window / 2;
    if (motions->HasHidden(begin, end)) {
      if (hooks.begins) {
        hooks.begins(std::max(0, begin - kBeside),
                     std::min(end + kBeside, motions->frames()));
      }
      windows.push_back(
          Refine(begin, end, kept, options, noise, hooks, motions));
      if (hooks.found) hooks.found(begin, kept);
    }
    if (is_last) break;
    begin = kept;
  }
  return windows;
}

}  // namespace splitfusion
