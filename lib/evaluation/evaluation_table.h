#ifndef SPLITFUSION_LIB_EVALUATION_EVALUATION_TABLE_H_
#define SPLITFUSION_LIB_EVALUATION_EVALUATION_TABLE_H_

#include <string>

#include "splitfusion/lib/evaluation/run_evaluation.h"

namespace splitfusion {

/// The evaluation as text for people, in millimetres and degrees.
std::string FormatTable(const RunEvaluation& evaluation);

/// The rows of a trajectory error alone.
std::string FormatTable(const TrajectoryError& error);

/// The rows of a surface error alone; `name` heads each row.
std::string FormatTable(const std::string& name, const SurfaceError& error);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_EVALUATION_TABLE_H_
