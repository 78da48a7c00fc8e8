#include "splitfusion/lib/energy/blas_threads.h"

#include <dlfcn.h>

namespace splitfusion {

void SetBlasThreads(int threads) {
  using SetThreads = void (*)(int);
  const auto set_threads = reinterpret_cast<SetThreads>(
      dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set_threads != nullptr) set_threads(threads);
}

}  // namespace splitfusion
