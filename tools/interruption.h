#ifndef SPLITFUSION_TOOLS_INTERRUPTION_H_
#define SPLITFUSION_TOOLS_INTERRUPTION_H_

namespace splitfusion {

/// From now on the first SIGINT, SIGTERM or SIGHUP (a closed terminal) only
/// sets Interrupted(), so that the program can finish what it is at and write
/// what it has. A second one ends it.
void CatchInterruption();

/// Whether the program was asked to stop.
bool Interrupted();

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_INTERRUPTION_H_
