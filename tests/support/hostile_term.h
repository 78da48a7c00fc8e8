#ifndef SPLITFUSION_TESTS_SUPPORT_HOSTILE_TERM_H_
#define SPLITFUSION_TESTS_SUPPORT_HOSTILE_TERM_H_

#include <ceres/jet.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// What a functor does to a residual that was right.
enum class Fault {
  kNone,
  kNan,           ///< The value is no number.
  kInfinite,      ///< The value is -infinity.
  kNanSlope,      ///< The value is right, its derivatives are no numbers.
  kLateNanSlope,  ///< Likewise, once the point has moved.
  kInfiniteSlope,
  kNanWithoutSlope,  ///< The value is none where no derivatives are asked for.
  kHuge,             ///< 1e300, with derivatives like it.
  kHugeSlope,        ///< Derivatives times 1e200.
  kSteep,            ///< Value and derivatives times 1e60.
  kFaint,            ///< Value and derivatives times 1e-300.
  kConstant,         ///< Depends on nothing.
  kWrongSign,        ///< Derivatives times -1.
  kOnePerMille,      ///< Derivatives times 1.001.
  kNoise,            ///< Another value with each call.
  kRefuses,          ///< The functor returns false.
  kThrows,           ///< std::runtime_error
  kThrowsInputError,
  kThrowsNumber,
};

namespace internal {

inline double* ValueOf(double* x) { return x; }
template <int N>
double* ValueOf(ceres::Jet<double, N>* x) {
  return &x->a;
}

inline void ScaleSlope(double /*factor*/, double* /*x*/) {}
template <int N>
void ScaleSlope(double factor, ceres::Jet<double, N>* x) {
  x->v *= factor;
}

/// Makes a residual, which is not 0, what the fault says; false: it is refused.
template <typename T>
bool Spoil(Fault fault, T* residual) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double* value = ValueOf(residual);
  switch (fault) {
    case Fault::kNone:
      break;
    case Fault::kNan:
      *value = std::nan("");
      break;
    case Fault::kInfinite:
      *value = -kInfinity;
      break;
    case Fault::kNanSlope:
      ScaleSlope(std::nan(""), residual);
      break;
    case Fault::kLateNanSlope:
      if (std::abs(*value + 0.01) > 1e-6) {
        ScaleSlope(std::nan(""), residual);
      }
      break;
    case Fault::kInfiniteSlope:
      ScaleSlope(kInfinity, residual);
      break;
    case Fault::kNanWithoutSlope:
      if (std::is_same_v<T, double>) *value = std::nan("");
      break;
    case Fault::kHuge:
      *residual *= 1e302;
      break;
    case Fault::kHugeSlope:
      ScaleSlope(1e200, residual);
      break;
    case Fault::kSteep:
      *residual *= 1e60;
      break;
    case Fault::kFaint:
      *residual *= 1e-300;
      break;
    case Fault::kConstant:
      *residual = T(0.02);
      break;
    case Fault::kWrongSign:
      ScaleSlope(-1, residual);
      break;
    case Fault::kOnePerMille:
      ScaleSlope(1.001, residual);
      break;
    case Fault::kNoise:
      *value += 1e-3 * std::rand() / RAND_MAX;
      break;
    case Fault::kRefuses:
      return false;
    case Fault::kThrows:
      throw std::runtime_error("no such map");
    case Fault::kThrowsInputError:
      throw InputError("map.png: no such map");
    case Fault::kThrowsNumber:
      throw 42;
  }
  return true;
}

}  // namespace internal

/// How far a warped point is before the plane z = 1.01; of a mesh at z = 1
/// where nothing has moved, -1 cm.
struct SpoiledPoint {
  static constexpr int kResiduals = 1;
  Fault fault = Fault::kNone;
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    residual[0] = x[2] - T(1.01);
    return internal::Spoil(fault, residual);
  }
};

/// The same of a node that began at z = 1.
struct SpoiledNode {
  static constexpr int kResiduals = 1;
  Fault fault = Fault::kNone;
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    residual[0] = twists[0][5] - T(0.01);
    return internal::Spoil(fault, residual);
  }
};

/// The same of a point and one unknown u: r = z - 1.01 + 0.1 u.
struct SpoiledGain {
  static constexpr int kResiduals = 1;
  static constexpr int kUnknowns = 1;
  Fault fault = Fault::kNone;
  template <typename T>
  bool operator()(const T* x, const T* unknowns, T* residual) const {
    residual[0] = x[2] - T(1.01) + T(0.1) * unknowns[0];
    return internal::Spoil(fault, residual);
  }
};

/// A prior of the unknown: u - 0.01.
struct SpoiledPrior {
  static constexpr int kResiduals = 1;
  static constexpr int kUnknowns = 1;
  Fault fault = Fault::kNone;
  template <typename T>
  bool operator()(const T* unknowns, T* residual) const {
    residual[0] = unknowns[0] - T(0.01);
    return internal::Spoil(fault, residual);
  }
};

/// A term whose members do what they are told.
class HostileTerm : public EnergyTerm {
 public:
  std::function<void(OptionList*)> list;
  std::function<std::vector<Unknown>()> unknowns;
  std::function<void(const EnergyInput&, ResidualSink*)> add;
  std::function<std::unique_ptr<TermState>()> new_state;
  std::function<void(TermState*)> prepare;

  void List(OptionList* options) override {
    if (list) list(options);
  }
  std::vector<Unknown> Unknowns() const override {
    return unknowns ? unknowns() : std::vector<Unknown>();
  }
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    if (add) add(input, sink);
  }
  std::unique_ptr<TermState> NewState() const override {
    return new_state ? new_state() : nullptr;
  }
  void Prepare(const EnergyInput& /*input*/, TermState* state) const override {
    if (prepare) prepare(state);
  }
};

/// The model points of all correspondences.
inline std::vector<const ModelSample*> ModelSamplesOf(
    const EnergyInput& input) {
  std::vector<const ModelSample*> samples;
  for (const Correspondence& c : input.correspondences) {
    samples.push_back(&c.model);
  }
  return samples;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_HOSTILE_TERM_H_
