#ifndef SPLITFUSION_LIB_REPORT_CHECKPOINT_SCHEDULE_H_
#define SPLITFUSION_LIB_REPORT_CHECKPOINT_SCHEDULE_H_

#include <algorithm>

namespace splitfusion {

/// When the state of a run is saved.
class CheckpointSchedule {
 public:
  /// Every so many frames; 0: every ten seconds, or more seldom where saving
  /// would cost more than a fiftieth of the time; -1: never.
  explicit CheckpointSchedule(int every) : every_(every) {}

  /// Whether to save now that another frame is done. `seconds`: since the last
  /// save or the beginning.
  bool IsDue(double seconds) {
    ++frames_;
    if (every_ != 0) return every_ > 0 && frames_ >= every_;
    return seconds >= interval_;
  }

  /// The state was saved, which took `seconds`.
  void Saved(double seconds) {
    constexpr double kShare = 0.02;  // Speed.
    frames_ = 0;
    interval_ = std::max(kShortest, seconds / kShare);
  }

 private:
  static constexpr double kShortest = 10;  // Speed: seconds.

  int every_;
  int frames_ = 0;
  double interval_ = kShortest;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_CHECKPOINT_SCHEDULE_H_
