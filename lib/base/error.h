#ifndef SPLITFUSION_LIB_BASE_ERROR_H_
#define SPLITFUSION_LIB_BASE_ERROR_H_

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace splitfusion {

/// Bad user data or a bad option: a missing or truncated file, a wrong size,
/// an unknown name. The message is one line that names the file or field, the
/// value found and what was expected. Tools turn it into exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An option out of its range.
class OptionError : public InputError {
 public:
  /// "<field> = <value>: expected <expected>".
  OptionError(const std::string& field, const std::string& value,
              const std::string& expected)
      : InputError(field + " = " + value + ": expected " + expected),
        field_(field),
        expected_(expected) {}

  /// Name of the option.
  const std::string& field() const { return field_; }
  /// What its value should be.
  const std::string& expected() const { return expected_; }

 private:
  std::string field_;
  std::string expected_;
};

/// Checks one option; for use in the Check() members of option structs.
///
/// @throw OptionError unless `ok`.
/// Values that are not finite are refused whatever `ok` says.
template <typename T>
void CheckOption(bool ok, const std::string& field, const T& value,
                 const std::string& expected) {
  if constexpr (std::is_floating_point_v<T>) ok = ok && std::isfinite(value);
  if (ok) return;
  std::ostringstream text;
  text << value;
  throw OptionError(field, text.str(), expected);
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_ERROR_H_
