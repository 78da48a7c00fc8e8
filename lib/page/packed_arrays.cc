#include "splitfusion/lib/page/packed_arrays.h"

#include <zlib.h>

#include <nlohmann/json.hpp>

#include "splitfusion/lib/base/base64.h"

namespace splitfusion {
namespace {

std::uint32_t Zigzag(std::uint32_t difference) {
  return (difference << 1) ^ ((difference >> 31) != 0 ? ~0u : 0u);
}

}  // namespace

nlohmann::ordered_json PackedArrays::Add(
    const std::vector<std::int32_t>& values, int lag) {
  std::vector<std::uint32_t> packed(values.size());
  std::uint32_t all = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto before = static_cast<std::uint32_t>(
        i < static_cast<std::size_t>(lag) ? 0 : values[i - lag]);
    packed[i] = Zigzag(static_cast<std::uint32_t>(values[i]) - before);
    all |= packed[i];
  }
  const std::size_t offset = bytes_.size();
  int planes = 0;
  for (; planes < 4 && (all >> (8 * planes)) != 0; ++planes) {
    for (const std::uint32_t value : packed) {
      bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * planes)));
    }
  }
  return {{"offset", offset},
          {"count", values.size()},
          {"planes", planes},
          {"lag", lag}};
}

std::string PackedArrays::Text() const {
  uLongf size = compressBound(bytes_.size());
  std::vector<std::uint8_t> deflated(size);
  compress2(deflated.data(), &size, bytes_.data(), bytes_.size(),
            Z_DEFAULT_COMPRESSION);
  return Base64(deflated.data(), size);
}

}  // namespace splitfusion
