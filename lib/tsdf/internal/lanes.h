#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_LANES_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_LANES_H_

#include <cstdint>
#include <cstring>

/// Functions that work on vectors are inlined into their callers, once for
/// every instruction set.
#define SPLITFUSION_INLINE inline __attribute__((always_inline))

namespace splitfusion {
namespace internal {

constexpr int kLanes = 8;  ///< Numbers that are worked on side by side.

/// Eight numbers.
using Lanes = float __attribute__((vector_size(sizeof(float) * kLanes)));
/// Eight integers, or eight conditions: 0 or -1.
using Flags = std::int32_t __attribute__((vector_size(sizeof(float) * kLanes)));

/// Reads eight numbers from anywhere.
SPLITFUSION_INLINE void Load(const float* from, Lanes* to) {
  std::memcpy(to, from, sizeof(Lanes));
}

/// Writes eight numbers to anywhere.
SPLITFUSION_INLINE void Store(const Lanes& from, float* to) {
  std::memcpy(to, &from, sizeof(Lanes));
}

/// The nearest integers, halves away from zero like std::lround.
SPLITFUSION_INLINE void Round(const Lanes& x, Flags* nearest) {
  Flags bits;
  std::memcpy(&bits, &x, sizeof(bits));
  const Lanes below_half = Lanes{} + 0.49999997f;
  Flags half_bits;
  std::memcpy(&half_bits, &below_half, sizeof(half_bits));
  half_bits |= bits & INT32_MIN;  // With the sign of x.
  Lanes half;
  std::memcpy(&half, &half_bits, sizeof(half));
  *nearest = __builtin_convertvector(x + half, Flags);
}

/// Whether any flag is set.
SPLITFUSION_INLINE bool Any(const Flags& flags) {
  using Half = std::int64_t __attribute__((vector_size(sizeof(Flags) / 2)));
  Half halves[2];
  std::memcpy(halves, &flags, sizeof(halves));
  const Half both = halves[0] | halves[1];
  return (both[0] | both[1]) != 0;
}

/// Turns eight rows into eight columns.
SPLITFUSION_INLINE void Transpose(Lanes rows[kLanes]) {
  Lanes pairs[kLanes], fours[kLanes];
  for (int i = 0; i < kLanes; i += 2) {
    pairs[i] = __builtin_shuffle(rows[i], rows[i + 1],
                                 Flags{0, 8, 1, 9, 4, 12, 5, 13});
    pairs[i + 1] = __builtin_shuffle(rows[i], rows[i + 1],
                                     Flags{2, 10, 3, 11, 6, 14, 7, 15});
  }
  for (int i = 0; i < kLanes; ++i) {
    const Lanes& low = pairs[(i & 4) | ((i >> 1) & 1)];
    const Lanes& high = pairs[(i & 4) | 2 | ((i >> 1) & 1)];
    fours[i] =
        (i & 1) == 0
            ? __builtin_shuffle(low, high, Flags{0, 1, 8, 9, 4, 5, 12, 13})
            : __builtin_shuffle(low, high, Flags{2, 3, 10, 11, 6, 7, 14, 15});
  }
  for (int i = 0; i < kLanes / 2; ++i) {
    rows[i] = __builtin_shuffle(fours[i], fours[i + 4],
                                Flags{0, 1, 2, 3, 8, 9, 10, 11});
    rows[i + 4] = __builtin_shuffle(fours[i], fours[i + 4],
                                    Flags{4, 5, 6, 7, 12, 13, 14, 15});
  }
}

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_LANES_H_
