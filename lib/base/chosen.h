#ifndef SPLITFUSION_LIB_BASE_CHOSEN_H_
#define SPLITFUSION_LIB_BASE_CHOSEN_H_

#include <cstddef>
#include <vector>

namespace splitfusion {

/// The values of the members, in their order. `members`: of every one whether
/// it is; the last ones may have no value.
template <typename T>
std::vector<T> Chosen(const std::vector<T>& values,
                      const std::vector<char>& members) {
  std::vector<T> chosen;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (members[i] != 0) chosen.push_back(values[i]);
  }
  return chosen;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_CHOSEN_H_
