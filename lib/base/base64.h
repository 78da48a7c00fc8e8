#ifndef SPLITFUSION_LIB_BASE_BASE64_H_
#define SPLITFUSION_LIB_BASE_BASE64_H_

#include <cstddef>
#include <string>

namespace splitfusion {

/// Bytes as text (RFC 4648, with padding), for files within a page.
std::string Base64(const void* bytes, std::size_t count);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_BASE64_H_
