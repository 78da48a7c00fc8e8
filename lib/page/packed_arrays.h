#ifndef SPLITFUSION_LIB_PAGE_PACKED_ARRAYS_H_
#define SPLITFUSION_LIB_PAGE_PACKED_ARRAYS_H_

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace splitfusion {

/// Arrays of whole numbers within a page, as small as deflate makes them: of
/// every value the difference from the one `lag` before it, modulo 2^32, zigzag
/// (0, -1, 1, -2, ... are 0, 1, 2, 3, ...), in planes of bytes, low ones first.
/// `unpack.js` reads them.
class PackedArrays {
 public:
  /// Adds an array; `lag` > 0. Returns where it is: {"offset" (bytes), "count",
  /// "planes", "lag"}.
  nlohmann::ordered_json Add(const std::vector<std::int32_t>& values, int lag);

  /// All of them, deflated (RFC 1950), in base64.
  std::string Text() const;

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_PACKED_ARRAYS_H_
