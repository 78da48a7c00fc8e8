#ifndef SPLITFUSION_LIB_SPLIT_MERGE_GROUPS_H_
#define SPLITFUSION_LIB_SPLIT_MERGE_GROUPS_H_

#include <set>
#include <string>
#include <vector>

namespace splitfusion {

/// Classes whose instances are one surface while they touch, as a person and
/// what the person holds. Groups chain: by "person+bag" and "bag+toy", a toy
/// on a bag is one surface with the person who holds the bag; it does not join
/// a person whom it touches alone.
struct MergeGroup {
  std::string body;            ///< Class of which the surface is.
  std::set<std::string> held;  ///< Classes that join it.
};

/// Groups from text: entries separated by commas, the class names of each
/// joined by `+`, the body's first, as "person+teddy bear+handbag,cat+mouse".
/// Blanks around names do not count. Empty text: no group.
///
/// @throw OptionError on an empty name, an entry of one class, a class twice
/// in an entry.
std::vector<MergeGroup> ParseMergeGroups(const std::string& text);

/// Whether one of the groups names `held` as a class that joins `body`.
bool MayHold(const std::vector<MergeGroup>& groups, const std::string& body,
             const std::string& held);

/// Whether one of the groups names the class as one that joins others.
bool MayBeHeld(const std::vector<MergeGroup>& groups,
               const std::string& class_name);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_MERGE_GROUPS_H_
