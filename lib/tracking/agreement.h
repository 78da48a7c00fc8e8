#ifndef SPLITFUSION_LIB_TRACKING_AGREEMENT_H_
#define SPLITFUSION_LIB_TRACKING_AGREEMENT_H_

namespace splitfusion {

/// A model point and a live point agree within this distance, metres.
constexpr float kAgreeingDistance = 0.02f;
/// And within this difference of grey values, of a range of 1.
constexpr float kAgreeingGrey = 0.2f;

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_AGREEMENT_H_
