#ifndef SPLITFUSION_TOOLS_PROGRESS_LINE_H_
#define SPLITFUSION_TOOLS_PROGRESS_LINE_H_

#include <string>

#include "splitfusion/lib/base/stopwatch.h"

namespace splitfusion {

/// Says on stderr how far a program is: "DONE/TOTAL WHAT, SECONDS s left", the
/// last only if it is above 0. On a terminal it is one line that is rewritten;
/// elsewhere, as in a log file, a line of the log now and then.
class ProgressLine {
 public:
  ~ProgressLine() { End(); }

  /// `done` of `total` are done.
  void Show(int done, int total, const std::string& what, double seconds_left);

  /// Ends the line, so that a message can follow.
  void End();

 private:
  bool begun_ = false;
  Stopwatch since_line_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_PROGRESS_LINE_H_
