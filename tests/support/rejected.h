#ifndef SPLITFUSION_TESTS_SUPPORT_REJECTED_H_
#define SPLITFUSION_TESTS_SUPPORT_REJECTED_H_

#include <string>

#include "splitfusion/lib/association/association_counts.h"

namespace splitfusion {

/// Model points rejected for a reason, or for any.
inline int Rejected(const AssociationCounts& counts,
                    const std::string& reason = "") {
  int count = 0;
  for (const RejectedPoints& r : counts.rejected) {
    if (reason.empty() || r.reason == reason) count += r.count;
  }
  return count;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_REJECTED_H_
