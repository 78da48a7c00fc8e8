#include "splitfusion/lib/energy/term_unknowns.h"

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

TermUnknowns::TermUnknowns(const SurfaceProblem& problem) : first_(1, 0) {
  for (const WeightedTerm& term : problem.energy) {
    for (const Unknown& unknown : term.term->Unknowns()) {
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
    begin_[i].initial = begin_[i].final = problem.unknowns[i];
  }
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

std::vector<double> ScalesOf(const std::vector<Unknown>& unknowns) {
  std::vector<double> scales;
  for (const Unknown& unknown : unknowns) scales.push_back(unknown.scale);
  return scales;
}

}  // namespace splitfusion
