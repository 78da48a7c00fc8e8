#ifndef SPLITFUSION_LIB_ENERGY_TWIST_H_
#define SPLITFUSION_LIB_ENERGY_TWIST_H_

namespace splitfusion {

/// Size of a node's parameter block: the twist [omega (rad), tau (m)].
constexpr int kTwistSize = 6;  // Layout.

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TWIST_H_
