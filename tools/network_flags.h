#ifndef SPLITFUSION_TOOLS_NETWORK_FLAGS_H_
#define SPLITFUSION_TOOLS_NETWORK_FLAGS_H_

#include <memory>

#include "splitfusion/lib/segmentation/network_segmenter.h"

namespace splitfusion {

/// True if the flags name a network.
///
/// @throw InputError if they name a decoder only.
bool HasNetworkFlags();

/// The network that segments, from the flags of sf_segment and sf_run.
///
/// @throw InputError if a flag's value is out of its range, or the network does
///     not fit.
std::unique_ptr<NetworkSegmenter> NetworkFromFlags();

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_NETWORK_FLAGS_H_
