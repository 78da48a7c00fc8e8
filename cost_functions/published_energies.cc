#include "splitfusion/cost_functions/published_energies.h"

#include "splitfusion/lib/base/any_of.h"
#include "splitfusion/lib/base/error.h"

namespace splitfusion {

const std::vector<PublishedEnergy>& PublishedEnergies() {
  static const std::vector<PublishedEnergy> energies = {
      {"splitfusion", "point_to_plane(weight=1) arap(weight=8)",
       "SplitFusion, Eq. 4 to 6, as printed"},
      {"dynamicfusion",
       "point_to_plane(weight=1,loss=tukey,scale=0.01) "
       "arap(weight=8,loss=huber,scale=0.0001)",
       "Newcombe et al. 2015; without their hierarchy of nodes and "
       "the weights of its edges"},
      {"volumedeform",
       "point_to_plane(weight=1) tracks(weight=16) arap(weight=8)",
       "Innmann et al. 2016; tracks by optical flow in place of "
       "SIFT features"},
      {"surfelwarp", "point_to_plane(weight=1) arap(weight=8)",
       "Gao and Tedrake 2018: terms and losses are those of "
       "splitfusion"}};
  return energies;
}

std::string PublishedTerms(const std::string& name) {
  std::vector<std::string> names;
  for (const PublishedEnergy& energy : PublishedEnergies()) {
    if (energy.name == name) return energy.terms;
    names.push_back(energy.name);
  }
  throw OptionError("energy", name, AnyOf(names));
}

}  // namespace splitfusion
