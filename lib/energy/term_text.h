#ifndef SPLITFUSION_LIB_ENERGY_TERM_TEXT_H_
#define SPLITFUSION_LIB_ENERGY_TERM_TEXT_H_

#include <string>
#include <utility>
#include <vector>

namespace splitfusion {

/// One entry of the text of an energy, as `arap(weight=8)` or
/// `person.arap(weight=4,loss=huber)`.
struct TermText {
  std::string of_class;  ///< Before the dot; empty: of all surfaces.
  std::string name;      ///< Of the term; empty where a name is missing.
  /// Keys and values, in their order.
  std::vector<std::pair<std::string, std::string>> options;
};

/// The entries of a text, in their order. It ends with one that has no name if
/// a name is missing.
///
/// @throw InputError if a bracket is not closed, an option is no key=value, or
/// a
///     key stands twice in one bracket.
std::vector<TermText> SplitTerms(const std::string& text);

/// Names stand in texts like `name(key=value)`.
///
/// @throw OptionError unless it is of letters, digits and _; `what`: is named.
void CheckName(const std::string& what, const std::string& name);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TERM_TEXT_H_
