#include "splitfusion/lib/base/random_id.h"

#include <random>

namespace splitfusion {

std::string RandomId() {
  constexpr char kDigits[] = "0123456789abcdef";
  std::random_device random;
  std::string id(32, '0');
  for (char& digit : id) digit = kDigits[random() % 16];
  return id;
}

}  // namespace splitfusion
