#ifndef SPLITFUSION_COST_FUNCTIONS_PUBLISHED_ENERGIES_H_
#define SPLITFUSION_COST_FUNCTIONS_PUBLISHED_ENERGIES_H_

#include <string>
#include <vector>

namespace splitfusion {

/// An energy of the literature in the terms of the toolkit.
struct PublishedEnergy {
  std::string name;    ///< As in --energy.
  std::string terms;   ///< Syntax of ParseEnergy().
  std::string source;  ///< Paper, and what is not the same.
};

/// All of them. Sums are means here, so that weights are the toolkit's own.
const std::vector<PublishedEnergy>& PublishedEnergies();

/// The terms of the energy of this name.
///
/// @throw OptionError if there is none; lists the known ones.
std::string PublishedTerms(const std::string& name);

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_PUBLISHED_ENERGIES_H_
