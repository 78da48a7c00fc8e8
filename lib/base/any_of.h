#ifndef SPLITFUSION_LIB_BASE_ANY_OF_H_
#define SPLITFUSION_LIB_BASE_ANY_OF_H_

#include <string>
#include <vector>

namespace splitfusion {

/// "a, b or c", for messages.
inline std::string AnyOf(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 < words.size() ? ", " : " or ";
    text += words[i];
  }
  return text;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_ANY_OF_H_
