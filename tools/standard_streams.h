#ifndef SPLITFUSION_TOOLS_STANDARD_STREAMS_H_
#define SPLITFUSION_TOOLS_STANDARD_STREAMS_H_

namespace splitfusion {

/// Makes a program independent of who listens to it; the first call of main().
/// Standard streams that are closed are opened on /dev/null: else the next file
/// that is opened gets their number, and messages go into it. A reader that
/// has gone (`2>&1 | head -1`) and a limit on the size of files (`ulimit -f`)
/// no longer kill the program: writing fails instead.
void SecureStandardStreams();

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_STANDARD_STREAMS_H_
