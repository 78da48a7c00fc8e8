#ifndef SPLITFUSION_LIB_BASE_OPTION_LIST_H_
#define SPLITFUSION_LIB_BASE_OPTION_LIST_H_

#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace splitfusion {

/// Numbers from `low` to `high`.
struct Range {
  double low = -std::numeric_limits<double>::infinity();  ///< The least.
  double high = std::numeric_limits<double>::infinity();  ///< The greatest.
  bool above_low = false;   ///< `low` itself is not in it.
  bool below_high = false;  ///< `high` itself is not in it.

  /// From `low` on.
  static Range AtLeast(double low) { return {low}; }
  /// Above `low`.
  static Range Above(double low) {
    Range range{low};
    range.above_low = true;
    return range;
  }
  /// From 0 to 1.
  static Range Share() { return {0, 1}; }

  /// False also of what is not finite.
  bool Holds(double value) const;
  /// As in "> 0", "metres >= 2", "0..1", "0.001..1 metres, not 1".
  std::string Text(const std::string& unit = "") const;
};

/// One option: what it is called, what it may be and what it does.
struct Option {
  std::string name;  ///< That of its flag.
  /// The field that holds it; its default is that of the field.
  std::variant<bool*, int*, double*, std::string*> value;
  Range range;                       ///< Of a number.
  std::vector<std::string> choices;  ///< Of a text; empty: any.
  std::string unit;                  ///< Of a number, as "metres".
  std::string help;                  ///< One or two sentences.
  bool common = false;  ///< Shown by --help, not by --helpfull only.

  /// What it may be, as in "metres > 0" or "a, b or c".
  std::string Expected() const;
  /// Its value in the shortest text that gives it back.
  std::string ValueText() const;
  /// Whether the value is what is expected.
  bool Fits() const;
  /// @throw OptionError unless it fits.
  void Check() const;
  /// Reads the value from text.
  ///
  /// @throw OptionError if the text is not what is expected; the value is then
  ///     what it was.
  void Set(const std::string& text);
};

/// The options of a part of the method, and of its parts. Every struct of
/// options has a member List(OptionList*) that adds its fields, with all there
/// is to know of them: flags, checks and documents are made from it. What the
/// members return holds until the next call.
class OptionList {
 public:
  /// Adds a number.
  Option& Number(const std::string& name, int* value, const Range& range,
                 const std::string& unit, const std::string& help);
  /// Adds a number.
  Option& Number(const std::string& name, double* value, const Range& range,
                 const std::string& unit, const std::string& help);
  /// Adds a choice of yes and no.
  Option& Switch(const std::string& name, bool* value, const std::string& help);
  /// Adds one word of some.
  Option& Choice(const std::string& name, std::string* value,
                 const std::vector<std::string>& choices,
                 const std::string& help);
  /// Adds any text.
  Option& Text(const std::string& name, std::string* value,
               const std::string& help);
  /// Adds all options of a struct, their names after `prefix`.
  template <typename Options>
  void Part(const std::string& prefix, Options* options) {
    const std::string outer = std::exchange(prefix_, prefix_ + prefix);
    options->List(this);
    prefix_ = outer;
  }
  /// Asks for what a range does not say. `name`: of an option that was added
  /// before, in this struct.
  void Demand(bool holds, const std::string& name, const std::string& expected);

  /// In the order in which they were added.
  const std::vector<Option>& options() const { return options_; }

  /// @throw OptionError that names the first option that is out of its range,
  /// else the first for which a demand does not hold.
  void Check() const;

 private:
  std::string prefix_;
  std::vector<Option> options_;
  /// Index of an option, and what was expected of it.
  std::vector<std::pair<std::size_t, std::string>> violations_;
};

/// Checks a struct of options by its list.
///
/// @throw OptionError
template <typename Options>
void CheckOptions(Options options) {
  OptionList list;
  options.List(&list);
  list.Check();
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_OPTION_LIST_H_
