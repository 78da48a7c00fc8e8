#ifndef SPLITFUSION_LIB_SPLIT_SPLIT_DECISION_H_
#define SPLITFUSION_LIB_SPLIT_SPLIT_DECISION_H_

#include <string>

namespace splitfusion {

/// One decision, for the report.
struct SplitDecision {
  /// "matched": a detection of a known surface. "merged": a piece of one, or
  /// a new surface that turned out to be one that had left. "born", "revived":
  /// a new surface, an inactive one seen again. "missed", "inactive": a surface
  /// without detection, carried or given up. "pending", "ignored": a detection
  /// that may yet become a surface, or may not. "moves": an ignored one of a
  /// rigid class that is found to move on its own.
  std::string action;
  int surface = 0;         ///< Surface id, 0 if none.
  std::string class_name;  ///< Of the detection, or of a missed surface.
  double score = 0;        ///< Of the detection; 0 if none.
  double overlap = 0;      ///< IoU with the projected surface; 0 if none.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SPLIT_DECISION_H_
