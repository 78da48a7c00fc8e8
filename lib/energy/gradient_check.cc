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
constexpr double kStep = 1e-4;        // Maths: radians, metres, scales.
constexpr double kShrinking = 2;      // Maths: of the step, Ridders' method.
constexpr double kLeastSlope = 1e-6;  // Maths: smaller ones are rounding.
constexpr int kExtrapolations = 6;    // Maths.

/// Something for every number that is sought: BlockProblem::Start().
using Numbers = std::vector<double>;

/// Entries begin..end are -1 or 1, the same on every machine; the others 0.
Numbers RandomDirection(std::size_t size, std::size_t begin, std::size_t end,
                        std::mt19937* random) {
  Numbers direction(size, 0.0);
  for (std::size_t i = begin; i < end; ++i) {
    direction[i] = ((*random)() & 1) != 0 ? 1 : -1;
  }
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
      : blocks_(problem, graph), start_(blocks_.Start()) {
    finite_ = blocks_.Evaluate(start_, /*with_jacobians=*/true);
    BorderedMatrix matrix = blocks_.MakeMatrix();
    BorderedVector gradient;
    blocks_.Assemble(&matrix, &gradient);
    for (const Vector6& v : gradient.nodes) {
      gradient_.insert(gradient_.end(), v.begin(), v.end());
    }
    gradient_.insert(gradient_.end(), gradient.own.begin(), gradient.own.end());
  }

  bool finite() const { return finite_; }
  int residuals() const { return CountResiduals(blocks_.terms()); }

  /// Number of all that is sought.
  std::size_t size() const { return start_.size(); }
  /// Number of the term's own unknowns, which are the last.
  int unknowns() const { return blocks_.unknowns().size(); }

  double Derived(const Numbers& direction) const {
    double slope = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      slope += gradient_[i] * direction[i];
    }
    return slope;
  }

  double Measured(const Numbers& direction) {
    return Ridders([&](double step) {
      Numbers moved(size());
      for (std::size_t i = 0; i < size(); ++i) {
        moved[i] = start_[i] + step * direction[i];
      }
      blocks_.Evaluate(moved, /*with_jacobians=*/false);
      return blocks_.Cost();
    });
  }

 private:
  BlockProblem blocks_;
  Numbers start_;
  Numbers gradient_;
  bool finite_ = false;
};

/// Compares along directions of what is begin..end of all that is sought.
void CheckPart(std::size_t begin, std::size_t end, TermSlopes* slopes,
               GradientError* error) {
  std::mt19937 random(1);
  double largest = 0, off = 0;
  for (int i = 0; i < kDirections; ++i) {
    const Numbers direction =
        RandomDirection(slopes->size(), begin, end, &random);
    const double derived = slopes->Derived(direction);
    const double measured = slopes->Measured(direction);
    if (!slopes->finite() || !std::isfinite(measured + derived)) {
      ++error->failed;
      continue;
    }
    largest = std::max(largest, std::abs(measured));
    off = std::max(off, std::abs(derived - measured));
  }
  error->relative =
      std::max(error->relative, off / std::max(largest, kLeastSlope));
}

}  // namespace

std::vector<GradientError> CheckGradients(const SurfaceProblem& problem,
                                          const DeformationGraph& graph) {
  std::vector<GradientError> errors;
  const TermUnknowns unknowns(problem);
  const std::vector<double> values = unknowns.StartValues();
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
    part.links = problem.links;
    const auto own = values.begin() + unknowns.first(errors.size());
    part.unknowns.assign(own, own + unknowns.count(errors.size()));
    TermSlopes slopes(part, graph);
    GradientError error{term.options.name};
    const std::size_t twists = slopes.size() - slopes.unknowns();
    CheckPart(0, twists, &slopes, &error);
    if (slopes.unknowns() > 0) {
      CheckPart(twists, slopes.size(), &slopes, &error);
    }
    error.residuals = slopes.residuals();
    errors.push_back(error);
  }
  return errors;
}

}  // namespace splitfusion
