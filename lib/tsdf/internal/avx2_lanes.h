#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_AVX2_LANES_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_AVX2_LANES_H_

#include <immintrin.h>

#include "splitfusion/lib/tsdf/internal/lanes.h"

namespace splitfusion {
namespace internal {

/// EightLanes for processors with AVX2: the instructions that the compiler does
/// not find by itself. Gives the same numbers.
struct Avx2Lanes : EightLanes {
  /// `a` where the condition holds, else `b`.
  static SPLITFUSION_INLINE Lanes Select(const Flags& mask, const Lanes& a,
                                         const Lanes& b) {
    return _mm256_blendv_ps(b, a, (__m256)mask);
  }

  /// The same.
  static SPLITFUSION_INLINE Flags Select(const Flags& mask, const Flags& a,
                                         const Flags& b) {
    return (Flags)_mm256_blendv_ps((__m256)b, (__m256)a, (__m256)mask);
  }

  /// The higher of both.
  static SPLITFUSION_INLINE Lanes Max(const Lanes& a, const Lanes& b) {
    return _mm256_max_ps(a, b);
  }

  /// Whether any condition holds.
  static SPLITFUSION_INLINE bool Any(const Flags& flags) {
    return _mm256_movemask_ps((__m256)flags) != 0;
  }

  /// Two pairs of numbers at `index`, none negative, of an array of pairs.
  static SPLITFUSION_INLINE __m128d TwoPairs(const float (*pairs)[2],
                                             const std::int32_t index[2]) {
    const TwoIndices at(index);
    double pair[2];
    std::memcpy(&pair[0], pairs[at.first], sizeof(double));
    std::memcpy(&pair[1], pairs[at.second], sizeof(double));
    return _mm_set_pd(pair[1], pair[0]);
  }

  /// Reads pairs of numbers at `index`, none negative, of an array of pairs,
  /// and turns them round.
  static SPLITFUSION_INLINE void GatherPairs(const float (*pairs)[2],
                                             const std::int32_t index[8],
                                             Lanes* firsts, Lanes* seconds) {
    const auto two = [&](int i) { return TwoPairs(pairs, index + i); };
    const __m256d low =
        _mm256_insertf128_pd(_mm256_castpd128_pd256(two(0)), two(4), 1);
    const __m256d high =
        _mm256_insertf128_pd(_mm256_castpd128_pd256(two(2)), two(6), 1);
    *firsts =
        _mm256_shuffle_ps((__m256)low, (__m256)high, _MM_SHUFFLE(2, 0, 2, 0));
    *seconds =
        _mm256_shuffle_ps((__m256)low, (__m256)high, _MM_SHUFFLE(3, 1, 3, 1));
  }
};

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_AVX2_LANES_H_
