#ifndef SPLITFUSION_LIB_SEQUENCE_IMAGE_HEADER_H_
#define SPLITFUSION_LIB_SEQUENCE_IMAGE_HEADER_H_

#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace splitfusion {

/// What an image file says of itself, before it is decoded.
struct ImageHeader {
  cv::Size size;     ///< Pixels.
  int bits = 8;      ///< Of a channel as decoded, 8 or 16.
  int channels = 1;  ///< As decoded; those of the palette if there is one.
};

/// Reads the header of a PNG or JPEG file and looks for its end marker; cheap,
/// nothing is decoded. Empty for files of another format, of which only is
/// known that they are regular files and not empty.
///
/// @throw InputError if the file is missing, no regular file (which might never
///     end), empty, truncated, no image as its name says, or of more than 100
///     million pixels or 1 GiB.
std::optional<ImageHeader> ReadImageHeader(const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_IMAGE_HEADER_H_
