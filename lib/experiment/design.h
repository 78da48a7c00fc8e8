#ifndef SPLITFUSION_LIB_EXPERIMENT_DESIGN_H_
#define SPLITFUSION_LIB_EXPERIMENT_DESIGN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "splitfusion/lib/experiment/settings.h"

namespace splitfusion {

/// Every combination of the values, the last key changing fastest; one empty
/// combination if there is no axis.
///
/// @throw InputError if a value is a range, which only a random design can use.
std::vector<Settings> ExpandGrid(const std::vector<Axis>& axes);

/// `count` random combinations: of a range `lo..hi` a number uniform in it, of
/// `log:lo..hi` one uniform in its logarithm (whole numbers if both ends are),
/// of a list one of its values. The same `seed` gives the same combinations;
/// a greater `count` adds some, a further axis changes no other one.
///
/// @throw InputError if a range is not one, or there is no axis.
std::vector<Settings> DrawDesign(const std::vector<Axis>& axes, int count,
                                 std::uint64_t seed);

/// 64 bits that depend on every byte of a text, and on nothing else: the same
/// on all machines.
std::uint64_t StableHash(const std::string& text);

/// A number in [0, 1) that a text decides.
double StableUniform(const std::string& text);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_DESIGN_H_
