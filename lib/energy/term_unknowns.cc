#include "splitfusion/lib/energy/term_unknowns.h"

#include <cmath>
#include <set>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/term_call.h"

namespace splitfusion {
namespace {

/// C of BorderedMatrix is dense, and the residuals have columns for all.
constexpr std::size_t kMostUnknowns = 1000;  // Layout.

void CheckUnknown(const std::string& term, const Unknown& unknown) {
  CheckName("unknown", unknown.name);
  const std::string name = term + "." + unknown.name;
  CheckOption(std::isfinite(unknown.initial), "initial of unknown " + name,
              unknown.initial, "a finite number");
  CheckOption(std::isfinite(unknown.scale) && unknown.scale > 0,
              "scale of unknown " + name, unknown.scale, "a number above 0");
  CheckOption(std::isfinite(unknown.initial / unknown.scale),
              "scale of unknown " + name, unknown.scale,
              "a number that its values can be divided by");
}

}  // namespace

std::vector<Unknown> DeclaredUnknowns(const WeightedTerm& term) {
  const std::string& name = term.options.name;
  std::vector<Unknown> unknowns =
      CallTerm(name, "Unknowns()", [&] { return term.term->Unknowns(); });
  CheckOption(unknowns.size() <= kMostUnknowns,
              "unknowns of term '" + name + "'", unknowns.size(),
              "at most " + std::to_string(kMostUnknowns));
  std::set<std::string> names;
  for (const Unknown& unknown : unknowns) {
    CheckUnknown(name, unknown);
    CheckOption(names.insert(unknown.name).second, "unknown of a term",
                name + "." + unknown.name, "names that differ");
  }
  return unknowns;
}

TermUnknowns::TermUnknowns(const SurfaceProblem& problem) : first_(1, 0) {
  for (const WeightedTerm& term : problem.energy) {
    CheckTerm(term);
    for (const Unknown& unknown : DeclaredUnknowns(term)) {
      begin_.push_back({term.options.name, unknown.name, unknown.unit,
                        unknown.initial, unknown.initial});
      scales_.push_back(unknown.scale);
    }
    first_.push_back(size());
  }
  if (problem.unknowns.empty()) return;
  CheckOption(problem.unknowns.size() == begin_.size(), "unknowns",
              problem.unknowns.size(),
              std::to_string(size()) + ", as the terms declare");
  for (std::size_t i = 0; i < begin_.size(); ++i) {
    const double value = problem.unknowns[i];
    CheckOption(std::isfinite(value / scales_[i]),
                "start of unknown " + begin_[i].term + "." + begin_[i].name,
                value, "a finite number");
    begin_[i].initial = begin_[i].final = value;
  }
}

std::vector<double> TermUnknowns::ScalesOf(std::size_t term) const {
  const auto first = scales_.begin() + first_[term];
  return {first, first + count(term)};
}

std::vector<double> TermUnknowns::Start() const {
  std::vector<double> sought = StartValues();
  for (std::size_t i = 0; i < sought.size(); ++i) sought[i] /= scales_[i];
  return sought;
}

std::vector<double> TermUnknowns::StartValues() const {
  std::vector<double> values;
  for (const UnknownEstimate& estimate : begin_) {
    values.push_back(estimate.initial);
  }
  return values;
}

std::vector<UnknownEstimate> TermUnknowns::Estimates(
    const double* sought) const {
  std::vector<UnknownEstimate> estimates = begin_;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    estimates[i].final = scales_[i] * sought[i];
  }
  return estimates;
}

}  // namespace splitfusion
