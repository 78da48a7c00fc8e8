#include "progress_line.h"

#include <unistd.h>

#include <cstdio>

namespace splitfusion {

void ShowProgress(int done, int total, const std::string& what,
                  double seconds_left) {
  if (!isatty(STDERR_FILENO)) return;
  std::fprintf(stderr, "\r\033[K%d/%d %s", done, total, what.c_str());
  if (seconds_left > 0) std::fprintf(stderr, ", %.0f s left", seconds_left);
  if (done == total) EndProgress();
}

void EndProgress() {
  if (isatty(STDERR_FILENO)) std::fputc('\n', stderr);
}

}  // namespace splitfusion
