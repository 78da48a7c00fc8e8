#include "splitfusion/lib/split/merge_groups.h"

#include <algorithm>
#include <sstream>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

/// The parts of `text` between separators, without blanks around them.
std::vector<std::string> Parts(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text + separator);
  for (std::string part; std::getline(stream, part, separator);) {
    const std::size_t begin = part.find_first_not_of(" \t");
    const std::size_t end = part.find_last_not_of(" \t");
    parts.push_back(
        begin == std::string::npos ? "" : part.substr(begin, end - begin + 1));
  }
  return parts;
}

/// The group of one entry; without held classes if it is none.
MergeGroup ParseGroup(const std::string& entry) {
  const std::vector<std::string> names = Parts(entry, '+');
  const std::set<std::string> held(names.begin() + 1, names.end());
  const bool valid = held.size() + 1 == names.size() &&
                     !names.front().empty() && held.count("") == 0 &&
                     held.count(names.front()) == 0;
  return {names.front(), valid ? held : std::set<std::string>{}};
}

}  // namespace

std::vector<MergeGroup> ParseMergeGroups(const std::string& text) {
  std::vector<MergeGroup> groups;
  if (text.empty()) return groups;
  for (const std::string& entry : Parts(text, ',')) {
    groups.push_back(ParseGroup(entry));
    CheckOption(!groups.back().held.empty(), "merge_touching", text,
                "entries of at least two different classes, CLASS+CLASS,..., "
                "such as person+teddy bear");
  }
  return groups;
}

bool MayHold(const std::vector<MergeGroup>& groups, const std::string& body,
             const std::string& held) {
  return std::any_of(groups.begin(), groups.end(), [&](const MergeGroup& g) {
    return g.body == body && g.held.count(held) > 0;
  });
}

bool MayBeHeld(const std::vector<MergeGroup>& groups,
               const std::string& class_name) {
  return std::any_of(groups.begin(), groups.end(), [&](const MergeGroup& g) {
    return g.held.count(class_name) > 0;
  });
}

}  // namespace splitfusion
