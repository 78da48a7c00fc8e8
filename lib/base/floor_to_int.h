#ifndef SPLITFUSION_LIB_BASE_FLOOR_TO_INT_H_
#define SPLITFUSION_LIB_BASE_FLOOR_TO_INT_H_

namespace splitfusion {

/// Largest integer that is not above `x`, which must be within the range of
/// int. (std::floor is a function call for the processors that all are built
/// for.)
template <typename T>
inline int FloorToInt(T x) {
  const int truncated = static_cast<int>(x);
  return truncated - (static_cast<T>(truncated) > x ? 1 : 0);
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_FLOOR_TO_INT_H_
