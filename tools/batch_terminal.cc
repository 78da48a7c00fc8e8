#include "batch_terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

namespace splitfusion {

std::size_t TerminalWidth() {
  constexpr std::size_t kDefault = 80, kLeast = 20;
  if (const char* columns = std::getenv("COLUMNS")) {
    const long width = std::strtol(columns, nullptr, 10);
    if (width > 0) return std::max(kLeast, static_cast<std::size_t>(width));
  }
  winsize size = {};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    return std::max<std::size_t>(kLeast, size.ws_col);
  }
  return kDefault;
}

void ProgressLines::Show(const SweepProgress& progress) {
  constexpr double kSecondsBetween = 5;
  if (isatty(STDERR_FILENO)) {
    line_.Show(progress.done, progress.total,
               "runs, " + progress.last.record.task.name,
               progress.seconds_left);
    return;
  }
  const bool due = progress.done == progress.total || !said_ ||
                   since_.Seconds() > kSecondsBetween;
  if (!due) return;
  std::cerr << progress.ToString() << '\n';
  since_.Restart();
  said_ = true;
}

}  // namespace splitfusion
