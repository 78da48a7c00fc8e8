#ifndef SPLITFUSION_LIB_BASE_PEAK_MEMORY_H_
#define SPLITFUSION_LIB_BASE_PEAK_MEMORY_H_

#include <cstdint>

namespace splitfusion {

/// Largest resident size of this process so far, bytes.
std::int64_t PeakMemoryBytes();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_PEAK_MEMORY_H_
