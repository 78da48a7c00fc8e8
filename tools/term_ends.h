#ifndef SPLITFUSION_TOOLS_TERM_ENDS_H_
#define SPLITFUSION_TOOLS_TERM_ENDS_H_

#include <string>

namespace splitfusion {

/// Lets a program that a term ends from within, by a signal of its own fault or
/// by exit(), say on stderr which one it was. `program`: is named; must outlive
/// the program. A signal ends it as it would have; exit() ends it with
/// kExitFailure. Signals that something else catches are left alone.
void NameTermsThatEnd(const char* program);

/// "term 'NAME', PART: " of the term whose code runs on this thread; empty if
/// none does.
std::string RunningTerm();

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_TERM_ENDS_H_
