#include "splitfusion/lib/base/quoted.h"

#include <cstddef>

namespace splitfusion {
namespace {

constexpr std::size_t kMaxBytes = 60;

unsigned char ByteAt(const std::string& text, std::size_t at) {
  return at < text.size() ? static_cast<unsigned char>(text[at]) : 0;
}

/// Bytes of the UTF-8 character at `at`; 0 if there is none to be printed.
std::size_t CharacterSize(const std::string& text, std::size_t at) {
  const unsigned char lead = ByteAt(text, at);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7f ? 1 : 0;
  const std::size_t size =
      lead >= 0xf0 ? 4 : (lead >= 0xe0 ? 3 : (lead >= 0xc2 ? 2 : 0));
  if (lead > 0xf4) return 0;
  for (std::size_t k = 1; k < size; ++k) {
    if ((ByteAt(text, at + k) & 0xc0) != 0x80) return 0;
  }
  // U+0080..U+009F are control characters, too.
  return lead == 0xc2 && ByteAt(text, at + 1) < 0xa0 ? 0 : size;
}

std::string Escaped(unsigned char byte) {
  constexpr char kDigits[] = "0123456789abcdef";
  return {'\\', 'x', kDigits[byte / 16], kDigits[byte % 16]};
}

}  // namespace

std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (std::size_t at = 0; at < text.size();) {
    if (quoted.size() > kMaxBytes) return quoted + "...'";
    const std::size_t size = CharacterSize(text, at);
    quoted += size > 0 ? text.substr(at, size) : Escaped(ByteAt(text, at));
    at += size > 0 ? size : 1;
  }
  return quoted + "'";
}

}  // namespace splitfusion
