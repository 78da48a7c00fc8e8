#ifndef SPLITFUSION_LIB_EVALUATION_EVALUATION_JSON_H_
#define SPLITFUSION_LIB_EVALUATION_EVALUATION_JSON_H_

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace splitfusion {

struct RunEvaluation;
struct SurfaceError;
struct TrajectoryError;

/// What `evaluation.json` holds; keys in docs/evaluation.md.
nlohmann::ordered_json ToJson(const RunEvaluation& evaluation);

/// The keys `ate`, `rpe`, ... alone.
nlohmann::ordered_json ToJson(const TrajectoryError& error);

/// The keys `accuracy`, `completeness` and `f_score`.
nlohmann::ordered_json ToJson(const SurfaceError& error);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_EVALUATION_JSON_H_
