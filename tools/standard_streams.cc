#include "standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>

namespace splitfusion {

void SecureStandardStreams() {
  // open() gives the lowest number that is free.
  int descriptor = open("/dev/null", O_RDWR);
  while (descriptor >= 0 && descriptor <= STDERR_FILENO) {
    descriptor = open("/dev/null", O_RDWR);
  }
  if (descriptor >= 0) close(descriptor);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace splitfusion
