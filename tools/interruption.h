#ifndef SPLITFUSION_TOOLS_INTERRUPTION_H_
#define SPLITFUSION_TOOLS_INTERRUPTION_H_

namespace splitfusion {

/// What a second signal does, of whatever kind; a third one ends the program.
enum class SecondSignal {
  kEnds,    ///< Ends the program at once.
  kIsTold,  ///< Sets InterruptedTwice(): the program has others to end first.
};

/// From now on the first SIGINT, SIGTERM or SIGHUP (a closed terminal) only
/// sets Interrupted(), so that the program can finish what it is at and write
/// what it has.
void CatchInterruption(SecondSignal second = SecondSignal::kEnds);

/// Whether the program was asked to stop.
bool Interrupted();

/// Whether the program was asked to stop at once.
bool InterruptedTwice();

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_INTERRUPTION_H_
