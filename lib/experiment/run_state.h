#ifndef SPLITFUSION_LIB_EXPERIMENT_RUN_STATE_H_
#define SPLITFUSION_LIB_EXPERIMENT_RUN_STATE_H_

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace splitfusion {

/// What decides the result of a run, as sf_run tells it.
struct RunIdentityText {
  std::string identity;                        ///< Hash of all parts.
  std::map<std::string, std::string> parts;    ///< Resolved options, inputs.
  std::map<std::string, std::string> outputs;  ///< What is written of it.
};

/// The marker of a run directory, RUN/run.json.
struct RunState {
  bool exists = false;       ///< Whether there is one.
  std::string id;            ///< Of this very run; empty if unknown.
  std::string status;        ///< "complete" is the only success.
  std::string error;         ///< Of a run that failed.
  bool resumed = false;      ///< Whether it went on from a checkpoint.
  RunIdentityText identity;  ///< Of the result.
  std::map<std::string, double> bytes;  ///< Size of every file, by path.

  bool IsComplete() const { return status == "complete"; }
};

/// A JSON file; null if it is missing or broken.
nlohmann::ordered_json ReadJsonOrNull(const std::string& path);

/// Reads RUN/run.json; a broken one has the status "damaged".
RunState ReadRunState(const std::string& run);

/// The identity of a JSON object with `identity`, `identity_parts` and
/// `outputs`; what is missing or of another type is left out.
RunIdentityText IdentityFromJson(const nlohmann::ordered_json& json);

/// "terms.arap.weight 8 -> 4, ...": the first differences between two
/// identities; empty if there are none.
std::string Differences(const RunIdentityText& before,
                        const RunIdentityText& after);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_RUN_STATE_H_
