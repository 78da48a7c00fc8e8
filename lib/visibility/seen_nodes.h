#ifndef SPLITFUSION_LIB_VISIBILITY_SEEN_NODES_H_
#define SPLITFUSION_LIB_VISIBILITY_SEEN_NODES_H_

#include <vector>

#include "splitfusion/lib/association/correspondence.h"

namespace splitfusion {

/// A node counts as seen if so many correspondences hang on it (the sum of its
/// weights of Eq. 3), in part if fewer do.
constexpr double kSeenPoints = 4;

/// For each of a graph's `nodes` nodes, from 0 to 1, how far correspondences
/// tell where it is.
std::vector<double> SeenShares(
    const std::vector<Correspondence>& correspondences, int nodes);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_VISIBILITY_SEEN_NODES_H_
