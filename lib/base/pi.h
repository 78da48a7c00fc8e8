#ifndef SPLITFUSION_LIB_BASE_PI_H_
#define SPLITFUSION_LIB_BASE_PI_H_

namespace splitfusion {

/// The circle's constant, in the precision of what it is multiplied with.
template <typename T>
inline constexpr T kPi = static_cast<T>(3.14159265358979323846L);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_PI_H_
