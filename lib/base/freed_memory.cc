#include "splitfusion/lib/base/freed_memory.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace splitfusion {

void KeepFreedMemory() {
#ifdef __GLIBC__
  constexpr int kMappedAlone = 32 << 20;  // The most that glibc allows.
  constexpr int kKept = 1 << 30;
  constexpr int kGrowth = 64 << 20;
  mallopt(M_MMAP_THRESHOLD, kMappedAlone);
  mallopt(M_TRIM_THRESHOLD, kKept);
  mallopt(M_TOP_PAD, kGrowth);
#endif
}

}  // namespace splitfusion
