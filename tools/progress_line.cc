#include "progress_line.h"

#include <glog/logging.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace splitfusion {
namespace {

/// Seconds between two lines of a log.
constexpr double kLogInterval = 30;

}  // namespace

void ProgressLine::End() {
  if (begun_) std::fputc('\n', stderr);
  begun_ = false;
}

void ProgressLine::Show(int done, int total, const std::string& what,
                        double seconds_left) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (!terminal && since_line_.Seconds() < kLogInterval) return;
  std::string line =
      std::to_string(done) + "/" + std::to_string(total) + " " + what;
  if (seconds_left > 0) {
    line += ", " + std::to_string(std::lround(seconds_left)) + " s left";
  }
  if (terminal) {
    std::fprintf(stderr, "\r\033[K%s", line.c_str());
    begun_ = true;
  } else {
    LOG(INFO) << line;
    since_line_.Restart();
  }
}

}  // namespace splitfusion
