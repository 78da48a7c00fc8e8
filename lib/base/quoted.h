#ifndef SPLITFUSION_LIB_BASE_QUOTED_H_
#define SPLITFUSION_LIB_BASE_QUOTED_H_

#include <string>

namespace splitfusion {

/// Foreign text for a message of one line: in single quotes, shortened to about
/// 60 characters, with control characters and bytes that are no UTF-8 written
/// in hexadecimal, backslash xNN.
std::string Quoted(const std::string& text);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_QUOTED_H_
