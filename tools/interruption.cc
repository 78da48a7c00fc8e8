#include "interruption.h"

#include <csignal>

namespace splitfusion {
namespace {

// A signal handler can reach nothing else.
volatile std::sig_atomic_t interrupted = 0;

void Interrupt(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void CatchInterruption() {
  std::signal(SIGINT, Interrupt);
  std::signal(SIGTERM, Interrupt);
  // Under nohup it stays ignored.
  if (std::signal(SIGHUP, Interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

bool Interrupted() { return interrupted != 0; }

}  // namespace splitfusion
