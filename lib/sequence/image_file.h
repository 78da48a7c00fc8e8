#ifndef SPLITFUSION_LIB_SEQUENCE_IMAGE_FILE_H_
#define SPLITFUSION_LIB_SEQUENCE_IMAGE_FILE_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/sequence/image_header.h"

namespace splitfusion {

/// Reads a colour image (png, jpg, ...) as HxW 8UC3, BGR; an orientation that
/// the file asks for is ignored, since the depth has none.
///
/// @throw InputError if the file is missing, truncated or not an image.
cv::Mat ReadColorImage(const std::string& path);

/// Reads a depth image of one channel: one of 16 bit (PNG, PGM, TIFF) as HxW
/// 16UC1, one of floating-point numbers (TIFF, EXR) as HxW 32FC1.
///
/// @throw InputError if the file is missing, truncated, or neither of them.
cv::Mat ReadDepthImage(const std::string& path);

/// Reads a label or mask image, 8 or 16 bit, one channel, as HxW 16UC1.
///
/// @throw InputError if the file is missing, truncated, or has channels.
cv::Mat ReadLabelImage(const std::string& path);

/// What a file of `bytes` bytes reads as; `path` names it in messages. The
/// decoders fill a truncated picture with grey and only print a warning, wait
/// for what is no file, and take all memory for a size that is absurd: look at
/// the header first, ReadImageHeader().
///
/// @throw InputError if it is not an image.
cv::Mat DecodeImage(const std::string& path,
                    const std::vector<std::uint8_t>& bytes, int flags);

/// Header of a depth image; see ReadImageHeader().
///
/// @throw InputError as that one, and if it is not 16 or 32 bit, 1 channel.
std::optional<ImageHeader> ReadDepthHeader(const std::string& path);

/// Header of a label or mask image; see ReadImageHeader().
///
/// @throw InputError as that one, and if it has channels.
std::optional<ImageHeader> ReadLabelHeader(const std::string& path);

/// Bytes of an image in the format that the path's extension names.
/// `parameters`: of cv::imwrite().
///
/// @throw InputError if there is no image; names the path.
std::string EncodeImage(const std::string& path, const cv::Mat& image,
                        const std::vector<int>& parameters = {});

/// Writes EncodeImage() through a temporary name; a missing folder is created.
///
/// @throw InputError if the file cannot be written; names the path.
void WriteImage(const std::string& path, const cv::Mat& image,
                const std::vector<int>& parameters = {});

/// "640x480".
std::string ToString(cv::Size size);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_IMAGE_FILE_H_
