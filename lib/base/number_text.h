#ifndef SPLITFUSION_LIB_BASE_NUMBER_TEXT_H_
#define SPLITFUSION_LIB_BASE_NUMBER_TEXT_H_

#include <charconv>
#include <string>

namespace splitfusion {

/// The shortest text that reads back as exactly this number, whatever the
/// locale.
inline std::string NumberText(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof(text), value);
  return {text, end.ptr};
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_NUMBER_TEXT_H_
