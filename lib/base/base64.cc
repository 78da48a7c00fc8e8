#include "splitfusion/lib/base/base64.h"

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>

namespace splitfusion {

std::string Base64(const void* bytes, std::size_t count) {
  using boost::archive::iterators::base64_from_binary;
  using boost::archive::iterators::transform_width;
  // Its last step reads the rest of a group of three bytes.
  std::string padded(static_cast<const char*>(bytes), count);
  padded.resize((count + 2) / 3 * 3, '\0');
  using Characters =
      base64_from_binary<transform_width<std::string::const_iterator, 6, 8>>;
  std::string text(Characters(padded.cbegin()), Characters(padded.cend()));
  const std::size_t missing = padded.size() - count;
  text.replace(text.size() - missing, missing, missing, '=');
  return text;
}

}  // namespace splitfusion
