#ifndef SPLITFUSION_LIB_BASE_STOPWATCH_H_
#define SPLITFUSION_LIB_BASE_STOPWATCH_H_

#include <chrono>

namespace splitfusion {

/// Wall-clock time since construction or the last Restart(), in seconds.
class Stopwatch {
 public:
  /// Seconds since construction or the last Restart().
  double Seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }
  /// Returns the seconds so far and starts again from zero.
  double Restart() {
    const double seconds = Seconds();
    start_ = Clock::now();
    return seconds;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_STOPWATCH_H_
