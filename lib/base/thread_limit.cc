#include "splitfusion/lib/base/thread_limit.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstddef>
#include <opencv2/core/utility.hpp>
#include <thread>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

void SetBlasThreads(int threads) {
  using SetThreads = void (*)(int);
  const auto set_threads = reinterpret_cast<SetThreads>(
      dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set_threads != nullptr) set_threads(threads);
}

}  // namespace

int ResolveThreads(int threads) {
  CheckOption(threads >= 0 && threads <= 1024, "threads", threads,
              "1..1024, or 0 for one a core");
  if (threads > 0) return threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

ThreadLimit::ThreadLimit(int threads)
    : control_(tbb::global_control::max_allowed_parallelism,
               static_cast<std::size_t>(ResolveThreads(threads))) {
  cv::setNumThreads(ResolveThreads(threads));
  SetBlasThreads(1);
}

}  // namespace splitfusion
