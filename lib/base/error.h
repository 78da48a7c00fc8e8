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

/// Checks one option; for use in the Check() members of option structs.
///
/// @throw InputError "<field> = <value>: expected <expected>" unless `ok`.
/// Values that are not finite are refused whatever `ok` says.
template <typename T>
void CheckOption(bool ok, const std::string& field, const T& value,
                 const std::string& expected) {
  if constexpr (std::is_floating_point_v<T>) ok = ok && std::isfinite(value);
  if (ok) return;
  std::ostringstream message;
  message << field << " = " << value << ": expected " << expected;
  throw InputError(message.str());
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_ERROR_H_
