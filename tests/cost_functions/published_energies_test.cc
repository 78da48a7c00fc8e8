#include "splitfusion/cost_functions/published_energies.h"

#include <gtest/gtest.h>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

TEST(PublishedEnergies, AreMadeOfTermsThatThereAre) {
  for (const PublishedEnergy& energy : PublishedEnergies()) {
    const Energy parsed = ParseEnergy(energy.terms, BuiltinTerms());
    EXPECT_GE(parsed.size(), 2u) << energy.name;
    EXPECT_NO_THROW(CheckEnergy(parsed)) << energy.name;
    EXPECT_EQ(PublishedTerms(energy.name), energy.terms);
    EXPECT_FALSE(energy.source.empty());
  }
  ExpectInputError([] { PublishedTerms("best"); },
                   "energy = best: expected splitfusion, dynamicfusion, "
                   "volumedeform or surfelwarp");
}

}  // namespace
}  // namespace splitfusion
