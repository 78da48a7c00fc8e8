#ifndef SPLITFUSION_LIB_BASE_THREAD_LIMIT_H_
#define SPLITFUSION_LIB_BASE_THREAD_LIMIT_H_

#include <tbb/global_control.h>

namespace splitfusion {

/// `threads` as it is, or, of 0, one a core.
/// @throw InputError if it is not within 0..1024.
int ResolveThreads(int threads);

/// Limits the threads of TBB and OpenCV while it lives, and those of OpenBLAS,
/// if that is the BLAS at run time, to one: the dense blocks of a surface's
/// factorisation are small, so that more of them wait more than they work, and
/// change the last digits. Ceres has a number of its own, SolverOptions.
class ThreadLimit {
 public:
  /// At most ResolveThreads(threads).
  explicit ThreadLimit(int threads);

 private:
  tbb::global_control control_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_THREAD_LIMIT_H_
