#include "splitfusion/lib/experiment/run_state.h"

#include <filesystem>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

RunState ReadRunState(const std::string& run) {
  RunState state;
  try {
    state.marker = ReadRunMarker(run);
  } catch (const InputError&) {
    state.damage = "run.json: expected the marker of a run";
  }
  return state;
}

std::string FileDamage(const RunState& state, const std::string& run,
                       bool evaluated) {
  if (!state.marker) return state.damage;
  for (const std::string name : {"summary.json", "evaluation.json"}) {
    if (name == "evaluation.json" && !evaluated) continue;
    try {
      CheckRunFile(*state.marker, run, name);
    } catch (const InputError&) {
      return name + (std::filesystem::exists(std::filesystem::path(run) / name)
                         ? ": not as it was written"
                         : ": missing");
    }
  }
  return FindMissing(*state.marker, run);
}

}  // namespace splitfusion
