#include "interruption.h"

#include <csignal>

namespace splitfusion {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

// A signal handler can reach nothing else.
volatile std::sig_atomic_t to_catch = 0;
volatile std::sig_atomic_t caught = 0;

/// Runs with all of kSignals blocked.
void Interrupt(int /*signal*/) {
  caught = caught + 1;
  if (caught < to_catch) return;
  for (const int signal : kSignals) {
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

}  // namespace

void CatchInterruption(SecondSignal second) {
  to_catch = second == SecondSignal::kEnds ? 1 : 2;
  struct sigaction action = {};
  action.sa_handler = Interrupt;
  action.sa_flags = SA_RESTART;
  for (const int signal : kSignals) sigaddset(&action.sa_mask, signal);
  for (const int signal : kSignals) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    // Under nohup SIGHUP stays ignored, under sf_batch SIGTERM.
    if (signal != SIGINT && before.sa_handler == SIG_IGN) continue;
    sigaction(signal, &action, nullptr);
  }
}

bool Interrupted() { return caught > 0; }

bool InterruptedTwice() { return caught > 1; }

}  // namespace splitfusion
