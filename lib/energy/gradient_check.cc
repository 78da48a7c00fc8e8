#include "splitfusion/lib/energy/gradient_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "splitfusion/lib/energy/block_problem.h"

namespace splitfusion {
namespace {

constexpr int kDirections = 8;        // Speed.
constexpr double kStep = 1e-4;        // Maths: radians and metres.
constexpr double kShrinking = 2;      // Maths: of the step, Ridders' method.
constexpr double kLeastSlope = 1e-6;  // Maths: smaller ones are rounding.
constexpr int kExtrapolations = 6;    // Maths.

using Twists = std::vector<double>;

/// Entries -1 or 1: the same on every machine.
Twists RandomDirection(std::size_t size, std::mt19937* random) {
  Twists direction(size);
  for (double& entry : direction) entry = ((*random)() & 1) != 0 ? 1 : -1;
  return direction;
}

/// Derivative of `f` at 0 by extrapolation of symmetric differences to the
/// step 0; the extrapolation with the least estimate of its error.
template <typename Function>
double Ridders(const Function& f) {
  std::array<std::array<double, kExtrapolations>, kExtrapolations> a{};
  double step = kStep, best = 0;
  double error = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kExtrapolations; ++i, step /= kShrinking) {
    a[0][i] = (f(step) - f(-step)) / (2 * step);
    double factor = kShrinking * kShrinking;
    for (int j = 1; j <= i; ++j, factor *= kShrinking * kShrinking) {
      a[j][i] = (a[j - 1][i] * factor - a[j - 1][i - 1]) / (factor - 1);
      const double estimate = std::max(std::abs(a[j][i] - a[j - 1][i]),
                                       std::abs(a[j][i] - a[j - 1][i - 1]));
      if (estimate > error) continue;
      error = estimate;
      best = a[j][i];
    }
  }
  return best;
}

/// One term alone.
class TermSlopes {
 public:
  TermSlopes(const SurfaceProblem& problem, const DeformationGraph& graph)
      : blocks_(problem, graph), size_(kTwistSize * graph.size()) {
    finite_ = blocks_.Evaluate(Twists(size_, 0.0), /*with_jacobians=*/true);
    SymmetricBlockMatrix matrix = blocks_.MakeMatrix();
    blocks_.Assemble(&matrix, &gradient_);
  }

  bool finite() const { return finite_; }
  int residuals() const { return CountResiduals(blocks_.terms()); }

  double Derived(const Twists& direction) const {
    double slope = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      slope += gradient_[i / kTwistSize][i % kTwistSize] * direction[i];
    }
    return slope;
  }

  double Measured(const Twists& direction) {
    return Ridders([&](double step) {
      Twists twists(size_);
      for (std::size_t i = 0; i < size_; ++i) twists[i] = step * direction[i];
      blocks_.Evaluate(twists, /*with_jacobians=*/false);
      return blocks_.Cost();
    });
  }

 private:
  BlockProblem blocks_;
  std::size_t size_;
  std::vector<Vector6> gradient_;
  bool finite_ = false;
};

}  // namespace

std::vector<GradientError> CheckGradients(const SurfaceProblem& problem,
                                          const DeformationGraph& graph) {
  std::vector<GradientError> errors;
  for (const WeightedTerm& term : problem.energy) {
    const Energy alone = {term};
    SurfaceProblem part{alone, problem.correspondences, problem.camera};
    part.live = problem.live;
    part.before = problem.before;
    part.anneal = problem.anneal;
    part.lost = problem.lost;
    part.tracks = problem.tracks;
    part.surface = problem.surface;
    part.context = problem.context;
    TermSlopes slopes(part, graph);
    GradientError error{term.options.name};
    std::mt19937 random(1);
    double largest = 0, off = 0;
    for (int i = 0; i < kDirections; ++i) {
      const Twists direction =
          RandomDirection(kTwistSize * graph.positions.size(), &random);
      const double derived = slopes.Derived(direction);
      const double measured = slopes.Measured(direction);
      if (!slopes.finite() || !std::isfinite(measured + derived)) {
        ++error.failed;
        continue;
      }
      largest = std::max(largest, std::abs(measured));
      off = std::max(off, std::abs(derived - measured));
    }
    error.relative = off / std::max(largest, kLeastSlope);
    error.residuals = slopes.residuals();
    errors.push_back(error);
  }
  return errors;
}

}  // namespace splitfusion
