#include "splitfusion/lib/base/archive.h"

namespace splitfusion {
namespace internal {
namespace {

constexpr std::size_t kMaxDimensions = 32;  // Of OpenCV's matrices.

}  // namespace

MatHeader HeaderOf(const cv::Mat& mat) {
  MatHeader header;
  header.type = mat.type();
  if (!mat.empty()) {
    header.sizes.assign(mat.size.p, mat.size.p + mat.dims);
  }
  return header;
}

cv::Mat MakeMat(const MatHeader& header, int type,
                const ArchiveReader& reader) {
  if (header.sizes.empty()) return {};
  const bool is_type = header.type >= 0 && header.type <= CV_MAT_TYPE_MASK;
  if (!is_type || (type >= 0 && type != header.type)) {
    reader.Fail("image of type " + std::to_string(header.type) +
                (type < 0 ? ": there is none"
                          : ": expected type " + std::to_string(type)));
  }
  // Each size is a divisor of what may be there: no overflow.
  std::uint64_t room = reader.left() / CV_ELEM_SIZE(header.type);
  bool fits = header.sizes.size() >= 2 && header.sizes.size() <= kMaxDimensions;
  for (const std::int32_t size : header.sizes) {
    fits = fits && size > 0 && static_cast<std::uint64_t>(size) <= room;
    if (fits) room /= static_cast<std::uint64_t>(size);
  }
  if (!fits) reader.Fail("image of an absurd size");
  return cv::Mat(header.sizes, header.type);
}

}  // namespace internal
}  // namespace splitfusion
