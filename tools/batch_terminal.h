#ifndef SPLITFUSION_TOOLS_BATCH_TERMINAL_H_
#define SPLITFUSION_TOOLS_BATCH_TERMINAL_H_

#include <cstddef>

#include "progress_line.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/experiment/sweep.h"

namespace splitfusion {

/// Columns of the terminal: COLUMNS, or what it says, or 80.
std::size_t TerminalWidth();

/// Shows the progress of a sweep on stderr: one line on a terminal, and
/// otherwise lines for tasks that have ended, not more often than every few
/// seconds.
class ProgressLines {
 public:
  /// A task has ended.
  void Show(const SweepProgress& progress);

  /// Ends the line of a terminal.
  void End() { line_.End(); }

 private:
  ProgressLine line_;
  Stopwatch since_;
  bool said_ = false;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BATCH_TERMINAL_H_
