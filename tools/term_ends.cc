#include "term_ends.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

#include "splitfusion/lib/energy/term_call.h"
#include "tool_main.h"

namespace splitfusion {
namespace {

// A signal handler can reach nothing else.
const char* program_name = "";

/// What a signal handler may call.
void Write(std::initializer_list<const char*> texts) {
  for (const char* text : texts) {
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) return;
  }
}

const char* NameOf(int signal) {
  switch (signal) {
    case SIGSEGV:
      return "SIGSEGV, an access to memory that it has not";
    case SIGBUS:
      return "SIGBUS, an access to memory that is gone";
    case SIGFPE:
      return "SIGFPE, a division that has no result";
    case SIGILL:
      return "SIGILL, an instruction that there is not";
    default:
      return "SIGABRT, an abort";
  }
}

void Tell(const TermCall& call, const char* what) {
  Write({program_name, ": term '", call.term(), "', ", call.part(), ": ", what,
         "\n"});
}

void TellSignal(int signal) {
  const TermCall* call = TermCall::Current();
  if (call != nullptr) Tell(*call, NameOf(signal));
  std::signal(signal, SIG_DFL);
  // It is blocked until the handler returns.
  raise(signal);
}

void TellExit() {
  const TermCall* call = TermCall::Current();
  if (call == nullptr) return;
  Tell(*call, "has called exit()");
  _exit(kExitFailure);
}

}  // namespace

void NameTermsThatEnd(const char* program) {
  program_name = program;
  std::atexit(TellExit);
  struct sigaction action = {};
  action.sa_handler = TellSignal;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler == SIG_DFL) sigaction(signal, &action, nullptr);
  }
}

std::string RunningTerm() {
  const TermCall* call = TermCall::Current();
  if (call == nullptr) return "";
  return std::string("term '") + call->term() + "', " + call->part() + ": ";
}

}  // namespace splitfusion
