#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_LANES_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_LANES_H_

#include <cstdint>
#include <cstring>

#include "splitfusion/lib/base/vector_clones.h"

// Nothing below is called: what is passed is no matter.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace splitfusion {
namespace internal {

/// Eight numbers.
using Lanes = float __attribute__((vector_size(sizeof(float) * 8)));
/// Eight integers, or eight conditions: 0 or -1.
using Flags = std::int32_t __attribute__((vector_size(sizeof(float) * 8)));

/// Two indices, none negative, at once: half as many loads.
struct TwoIndices {
  explicit SPLITFUSION_INLINE TwoIndices(const std::int32_t index[2]) {
    std::uint64_t both;
    std::memcpy(&both, index, sizeof(both));
    first = both & UINT32_MAX;
    second = both >> 32;
  }
  std::uint64_t first, second;
};

/// Fusion eight voxels at a time, for any processor. Other packs of lanes are
/// Avx2Lanes and SixteenLanes: loops are written once for all, with these names
/// and the functions below.
struct EightLanes {
  static constexpr int kCount = 8;  ///< Numbers worked on side by side.
  using Real = Lanes;               ///< As many numbers.
  using Whole = Flags;              ///< As many integers.
  using Mask = Flags;               ///< As many conditions.
  /// As many integers that may wrap.
  using Wrapping =
      std::uint32_t __attribute__((vector_size(sizeof(std::uint32_t) * 8)));

  /// a < b.
  static SPLITFUSION_INLINE Flags Less(const Lanes& a, const Lanes& b) {
    return a < b;
  }

  /// a < b, of integers that are not negative; a negative a is not less.
  static SPLITFUSION_INLINE Flags Within(const Flags& a, const Flags& b) {
    return (a >= 0) & (a < b);
  }

  /// `a` where the condition holds, else `b`.
  static SPLITFUSION_INLINE Lanes Select(const Flags& mask, const Lanes& a,
                                         const Lanes& b) {
    return mask ? a : b;
  }

  /// The same.
  static SPLITFUSION_INLINE Flags Select(const Flags& mask, const Flags& a,
                                         const Flags& b) {
    return mask ? a : b;
  }

  /// The lower of both.
  static SPLITFUSION_INLINE Lanes Min(const Lanes& a, const Lanes& b) {
    return a < b ? a : b;
  }

  /// The higher of both.
  static SPLITFUSION_INLINE Lanes Max(const Lanes& a, const Lanes& b) {
    return b < a ? a : b;
  }

  /// Which integers are not 0.
  static SPLITFUSION_INLINE Flags NotZero(const Flags& numbers) {
    return numbers != 0;
  }

  /// Whether any condition holds.
  static SPLITFUSION_INLINE bool Any(const Flags& flags) {
    using Half = std::int64_t __attribute__((vector_size(sizeof(Flags) / 2)));
    Half halves[2];
    std::memcpy(halves, &flags, sizeof(halves));
    const Half both = halves[0] | halves[1];
    return (both[0] | both[1]) != 0;
  }

  /// The bits of numbers.
  static SPLITFUSION_INLINE Flags Bits(const Lanes& numbers) {
    Flags bits;
    std::memcpy(&bits, &numbers, sizeof(bits));
    return bits;
  }

  /// The numbers of bits.
  static SPLITFUSION_INLINE Lanes FromBits(const Flags& bits) {
    Lanes numbers;
    std::memcpy(&numbers, &bits, sizeof(numbers));
    return numbers;
  }

  /// Reads pairs of numbers at `index` of an array of pairs, and turns them
  /// round.
  static SPLITFUSION_INLINE void GatherPairs(const float (*pairs)[2],
                                             const std::int32_t index[8],
                                             Lanes* firsts, Lanes* seconds) {
    using Pair = double;
    using Pairs = Pair __attribute__((vector_size(sizeof(Lanes))));
    static_assert(sizeof(*pairs) == sizeof(Pair));
    Pair pair[8];
    for (int i = 0; i < 8; ++i) {
      std::memcpy(&pair[i], pairs[index[i]], sizeof(Pair));
    }
    const Pairs first = {pair[0], pair[1], pair[4], pair[5]};
    const Pairs second = {pair[2], pair[3], pair[6], pair[7]};
    Lanes low, high;
    std::memcpy(&low, &first, sizeof(low));
    std::memcpy(&high, &second, sizeof(high));
    *firsts = __builtin_shuffle(low, high, Flags{0, 2, 8, 10, 4, 6, 12, 14});
    *seconds = __builtin_shuffle(low, high, Flags{1, 3, 9, 11, 5, 7, 13, 15});
  }

  /// Reads the integers at `index` of an array.
  static SPLITFUSION_INLINE Flags Gather(const std::int32_t* numbers,
                                         const std::int32_t index[8]) {
    return Flags{numbers[index[0]], numbers[index[1]], numbers[index[2]],
                 numbers[index[3]], numbers[index[4]], numbers[index[5]],
                 numbers[index[6]], numbers[index[7]]};
  }
};

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_LANES_H_
