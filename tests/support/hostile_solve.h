#ifndef SPLITFUSION_TESTS_SUPPORT_HOSTILE_SOLVE_H_
#define SPLITFUSION_TESTS_SUPPORT_HOSTILE_SOLVE_H_

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "support/hostile_term.h"

namespace splitfusion {

/// How a solve with a hostile term is to end.
enum class End {
  kRefused,  ///< InputError
  kThrows,   ///< Another exception.
  kFails,    ///< The report says FAILURE, and the graph is as it was.
  kStays,    ///< The graph is as it was, and the report says why.
  kFinite,   ///< All is finite, and the energy is not above its start.
  kSolved,   ///< Likewise, and the surface has moved.
};

/// A term "hostile" that is minimised beside good ones.
struct HostileCase {
  std::string name;
  End end = End::kSolved;
  std::string text;  ///< Of the message.
  std::shared_ptr<HostileTerm> term;
  TermOptions options = {"hostile"};
  std::vector<double> start = {};  ///< Of its unknowns.
};

/// For messages of gtest.
void PrintTo(const HostileCase& hostile, std::ostream* out);

/// The name of a case, as of a test.
std::string NameOf(const ::testing::TestParamInfo<HostileCase>& info);

/// Expects that every solver ends as the case says, on a rigid surface and on
/// one that deforms.
void ExpectEnd(const HostileCase& hostile);

/// Values that no option takes.
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Options of the term, of this weight or loss.
TermOptions Weight(double weight);
TermOptions Loss(LossKind loss, double scale);

/// What a term adds.
using Add = std::function<void(const EnergyInput&, ResidualSink*)>;

/// An unknown without a unit.
Unknown Named(const std::string& name, double initial = 0, double scale = 1);

/// A term that adds this.
std::shared_ptr<HostileTerm> Adding(Add add);

/// The same, with unknowns of its own.
std::shared_ptr<HostileTerm> WithUnknowns(std::vector<Unknown> unknowns,
                                          Add add);

/// A term over all points, with a fault in each.
std::shared_ptr<HostileTerm> Points(Fault fault);

/// The same, with a fault in the last.
std::shared_ptr<HostileTerm> OnePoint(Fault fault);

/// A term over all nodes, with a fault in each.
std::shared_ptr<HostileTerm> Nodes(Fault fault);

/// A term over all points and an unknown, with a prior.
std::shared_ptr<HostileTerm> Gains(Fault of_points, Fault of_prior,
                                   const Unknown& unknown = Named("gain"));

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_HOSTILE_SOLVE_H_
