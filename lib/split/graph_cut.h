#ifndef SPLITFUSION_LIB_SPLIT_GRAPH_CUT_H_
#define SPLITFUSION_LIB_SPLIT_GRAPH_CUT_H_

#include <opencv2/core.hpp>

#include "splitfusion/lib/geometry/point_map.h"

namespace splitfusion {

/// Weights of the 3D min-cut of SplitFusion IV-A.
struct GraphCutOptions {
  int core_erosion = 5;     ///< Pixels; the eroded mask is surely foreground.
  int outer_dilation = 12;  ///< Pixels; beyond it is surely background.

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_GRAPH_CUT_H_
