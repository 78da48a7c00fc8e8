#ifndef SPLITFUSION_LIB_EXPERIMENT_SETTINGS_H_
#define SPLITFUSION_LIB_EXPERIMENT_SETTINGS_H_

#include <string>
#include <utility>
#include <vector>

namespace splitfusion {

/// Options of sf_run by key, a flag's name, terms.NAME.KEY or
/// CLASS.terms.NAME.KEY, in the order in which they were given; no key twice.
class Settings {
 public:
  /// Key and value.
  using Entry = std::pair<std::string, std::string>;

  /// Replaces the value of a key, or appends both.
  void Set(const std::string& key, const std::string& value);
  /// Sets all that `other` has.
  void SetAll(const Settings& other);
  /// Value of a key; null if it is not set.
  const std::string* Find(const std::string& key) const;

  /// All, in their order.
  const std::vector<Entry>& entries() const { return entries_; }
  /// Whether nothing is set.
  bool empty() const { return entries_.empty(); }

 private:
  std::vector<Entry> entries_;
};

/// A key with the values that a sweep gives it; a value `lo..hi` or
/// `log:lo..hi` is a range, for random designs.
struct Axis {
  std::string key;  ///< Flag of sf_run or [CLASS.]terms.NAME.KEY.
  std::vector<std::string> values;  ///< At least one.
};

/// Parts of `text` between separators that stand outside double quotes, without
/// the blanks around them; quotes stay, empty parts are left out.
std::vector<std::string> SplitOutsideQuotes(const std::string& text,
                                            char separator);

/// `text` without double quotes around it (two of them inside stand for one).
///
/// @throw InputError if a quote is not closed, or something follows it.
std::string Unquoted(const std::string& text);

/// "KEY=VALUE; KEY=VALUE"; a value with a semicolon, a comma or a quote stands
/// in double quotes.
///
/// @param field name for messages, such as "set".
/// @throw InputError if an entry has no '=', or a key occurs twice.
Settings ParseSettings(const std::string& text, const std::string& field);

/// "KEY=VALUE,VALUE; KEY=VALUE,VALUE", quoted as in ParseSettings.
///
/// @throw InputError as ParseSettings, or if a value is missing.
std::vector<Axis> ParseGrid(const std::string& text, const std::string& field);

/// Text that ParseSettings() reads back.
std::string SettingsText(const Settings& settings);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_SETTINGS_H_
