#include "splitfusion/lib/base/peak_memory.h"

#include <sys/resource.h>

namespace splitfusion {

std::int64_t PeakMemoryBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;  // Linux counts in KiB.
}

}  // namespace splitfusion
