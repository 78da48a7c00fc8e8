#ifndef SPLITFUSION_LIB_ENERGY_CORRESPONDENCE_RESIDUALS_H_
#define SPLITFUSION_LIB_ENERGY_CORRESPONDENCE_RESIDUALS_H_

#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/energy/residual_sink.h"

namespace splitfusion {

/// Adds one residual vector a correspondence, of a functor over its warped
/// model point: `make(c)` gives that of Correspondence c, in metres times the
/// root of its confidence. Their mean is weighted by the confidences. Call it
/// once, in EnergyTerm::AddResiduals().
template <typename Make>
void AddCorrespondenceResiduals(const std::vector<Correspondence>& pairs,
                                Make make, ResidualSink* sink) {
  std::vector<const ModelSample*> samples;
  std::vector<decltype(make(pairs.front()))> functors;
  samples.reserve(pairs.size());
  functors.reserve(pairs.size());
  double total = 0;
  for (const Correspondence& c : pairs) {
    samples.push_back(&c.model);
    functors.push_back(make(c));
    total += c.weight;
  }
  sink->AddWarpedPoints(samples, functors, total);
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_CORRESPONDENCE_RESIDUALS_H_
