#ifndef SPLITFUSION_LIB_BASE_RANDOM_ID_H_
#define SPLITFUSION_LIB_BASE_RANDOM_ID_H_

#include <string>

namespace splitfusion {

/// A name that no other has: 32 random hexadecimal digits.
std::string RandomId();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_RANDOM_ID_H_
