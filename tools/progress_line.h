#ifndef SPLITFUSION_TOOLS_PROGRESS_LINE_H_
#define SPLITFUSION_TOOLS_PROGRESS_LINE_H_

#include <string>

namespace splitfusion {

/// Rewrites the one line on stderr on which a program says how far it is:
/// "DONE/TOTAL WHAT, SECONDS s left", the last only if it is above 0. The line
/// ends when all is done. Says nothing unless stderr is a terminal.
void ShowProgress(int done, int total, const std::string& what,
                  double seconds_left);

/// Ends a line that stopped before all was done, so that a message can follow.
void EndProgress();

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_PROGRESS_LINE_H_
