#ifndef SPLITFUSION_LIB_REPORT_MONTAGE_H_
#define SPLITFUSION_LIB_REPORT_MONTAGE_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace splitfusion {

/// One picture of a montage.
struct MontageTile {
  std::string caption;  ///< Short; ASCII.
  cv::Mat picture;      ///< 8UC3.
};

/// Height of the caption above every tile of a montage, pixels.
inline constexpr int kCaptionHeight = 22;

/// Pictures row by row in `columns` columns on white, each under its caption,
/// 8UC3. All are brought to the size of the first. Of one picture per frame it
/// makes a contact sheet.
///
/// @throw InputError if there are no tiles, columns < 1, or a tile is empty or
///     not 8UC3.
cv::Mat MakeMontage(const std::vector<MontageTile>& tiles, int columns);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_MONTAGE_H_
