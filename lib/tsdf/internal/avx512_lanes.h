#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_AVX512_LANES_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_AVX512_LANES_H_

#include <immintrin.h>

#include "splitfusion/lib/tsdf/internal/avx2_lanes.h"

namespace splitfusion {
namespace internal {

/// Sixteen numbers.
using WideLanes = float __attribute__((vector_size(sizeof(float) * 16)));
/// Sixteen integers.
using WideFlags = std::int32_t __attribute__((vector_size(sizeof(float) * 16)));

/// Fusion sixteen voxels at a time, for processors with AVX-512: see
/// EightLanes, whose functions these are. Gives the same numbers.
struct SixteenLanes {
  static constexpr int kCount = 16;  ///< Numbers worked on side by side.
  using Real = WideLanes;            ///< As many numbers.
  using Whole = WideFlags;           ///< As many integers.
  using Mask = __mmask16;            ///< As many conditions.
  /// As many integers that may wrap.
  using Wrapping =
      std::uint32_t __attribute__((vector_size(sizeof(std::uint32_t) * 16)));

  /// a < b.
  static SPLITFUSION_INLINE __mmask16 Less(const WideLanes& a,
                                           const WideLanes& b) {
    return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
  }

  /// a < b, of integers that are not negative; a negative a is not less.
  static SPLITFUSION_INLINE __mmask16 Within(const WideFlags& a,
                                             const WideFlags& b) {
    return _mm512_cmplt_epu32_mask((__m512i)a, (__m512i)b);
  }

  /// `a` where the condition holds, else `b`.
  static SPLITFUSION_INLINE WideLanes Select(__mmask16 mask, const WideLanes& a,
                                             const WideLanes& b) {
    return _mm512_mask_blend_ps(mask, b, a);
  }

  /// The same.
  static SPLITFUSION_INLINE WideFlags Select(__mmask16 mask, const WideFlags& a,
                                             const WideFlags& b) {
    return (WideFlags)_mm512_mask_blend_epi32(mask, (__m512i)b, (__m512i)a);
  }

  /// The lower of both.
  static SPLITFUSION_INLINE WideLanes Min(const WideLanes& a,
                                          const WideLanes& b) {
    return _mm512_min_ps(a, b);
  }

  /// The higher of both.
  static SPLITFUSION_INLINE WideLanes Max(const WideLanes& a,
                                          const WideLanes& b) {
    return _mm512_max_ps(a, b);
  }

  /// Which integers are not 0.
  static SPLITFUSION_INLINE __mmask16 NotZero(const WideFlags& numbers) {
    return _mm512_test_epi32_mask((__m512i)numbers, (__m512i)numbers);
  }

  /// Whether any condition holds.
  static SPLITFUSION_INLINE bool Any(__mmask16 mask) { return mask != 0; }

  /// The bits of numbers.
  static SPLITFUSION_INLINE WideFlags Bits(const WideLanes& numbers) {
    return (WideFlags)_mm512_castps_si512(numbers);
  }

  /// The numbers of bits.
  static SPLITFUSION_INLINE WideLanes FromBits(const WideFlags& bits) {
    return _mm512_castsi512_ps((__m512i)bits);
  }

  /// Eight pairs of numbers at `index` of an array of pairs.
  static SPLITFUSION_INLINE __m512
  GatherEightPairs(const float (*pairs)[2], const std::int32_t index[8]) {
    const auto two = [&](int i) {
      return Avx2Lanes::TwoPairs(pairs, index + i);
    };
    const __m256d low =
        _mm256_insertf128_pd(_mm256_castpd128_pd256(two(0)), two(2), 1);
    const __m256d high =
        _mm256_insertf128_pd(_mm256_castpd128_pd256(two(4)), two(6), 1);
    return _mm512_castpd_ps(
        _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1));
  }

  /// Reads pairs of numbers at `index` of an array of pairs, and turns them
  /// round.
  static SPLITFUSION_INLINE void GatherPairs(const float (*pairs)[2],
                                             const std::int32_t index[16],
                                             WideLanes* firsts,
                                             WideLanes* seconds) {
    const __m512 low = GatherEightPairs(pairs, index);
    const __m512 high = GatherEightPairs(pairs, index + 8);
    const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18,
                                           20, 22, 24, 26, 28, 30);
    const __m512i odd = _mm512_add_epi32(even, _mm512_set1_epi32(1));
    *firsts = _mm512_permutex2var_ps(low, even, high);
    *seconds = _mm512_permutex2var_ps(low, odd, high);
  }

  /// Reads the integers at `index` of an array.
  static SPLITFUSION_INLINE WideFlags Gather(const std::int32_t* numbers,
                                             const std::int32_t index[16]) {
    const auto four = [&](int i) {
      const TwoIndices low(index + i), high(index + i + 2);
      __m128i words = _mm_cvtsi32_si128(numbers[low.first]);
      words = _mm_insert_epi32(words, numbers[low.second], 1);
      words = _mm_insert_epi32(words, numbers[high.first], 2);
      return _mm_insert_epi32(words, numbers[high.second], 3);
    };
    const __m256i low =
        _mm256_inserti128_si256(_mm256_castsi128_si256(four(0)), four(4), 1);
    const __m256i high =
        _mm256_inserti128_si256(_mm256_castsi128_si256(four(8)), four(12), 1);
    return (WideFlags)_mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
  }
};

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_AVX512_LANES_H_
