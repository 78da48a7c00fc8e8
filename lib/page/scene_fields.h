#ifndef SPLITFUSION_LIB_PAGE_SCENE_FIELDS_H_
#define SPLITFUSION_LIB_PAGE_SCENE_FIELDS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "splitfusion/lib/evaluation/recorded_run.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {

/// A value of the nodes of a surface by which a viewer colours it.
struct NodeField {
  /// Steps of `values`, metres.
  static constexpr double kUnit = 1e-4;  // Layout.

  std::string name;         ///< For programs.
  std::string title;        ///< For people.
  double top = 0;           ///< Upper end of the colours, metres.
  bool holds = false;       ///< From one of its frames to the next.
  std::vector<int> frames;  ///< Frame indices, ascending.
  /// By frame and node, in steps of kUnit; -1: not known.
  std::vector<std::int32_t> values;
};

/// Distance from the live depth (residuals.h5), and standard deviation of where
/// nodes are (uncertainty/), as far as the run has them.
///
/// @throw InputError if a file is broken.
std::vector<NodeField> FieldsOf(const RunPaths& paths,
                                const RecordedSurface& surface);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_SCENE_FIELDS_H_
