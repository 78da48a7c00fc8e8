#ifndef SPLITFUSION_TESTS_SUPPORT_CUSTOM_ENERGY_H_
#define SPLITFUSION_TESTS_SUPPORT_CUSTOM_ENERGY_H_

#include "splitfusion/lib/energy/term_registry.h"

namespace splitfusion {

/// Point-to-plane distances, ARAP, and a term of the user's own: over points,
/// where every fifth should be, and over node triples, the middle of which
/// stays between the others; all with losses.
Energy EnergyWithCustomTerm();

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_CUSTOM_ENERGY_H_
