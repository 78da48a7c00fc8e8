#ifndef SPLITFUSION_LIB_BASE_MIXED_BITS_H_
#define SPLITFUSION_LIB_BASE_MIXED_BITS_H_

#include <cstdint>

namespace splitfusion {

/// The finaliser of splitmix64 (Steele et al. 2014): spreads the bits of its
/// argument, so that near arguments have values that are far apart.
inline std::uint64_t MixedBits(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
  return bits ^ (bits >> 31);
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_MIXED_BITS_H_
