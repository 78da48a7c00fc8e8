#ifndef SPLITFUSION_LIB_TRACKING_IMAGE_FEATURES_H_
#define SPLITFUSION_LIB_TRACKING_IMAGE_FEATURES_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

namespace splitfusion {

/// About a feature, pixels: what it is described by.
constexpr int kWindowMargin = 24;

/// Points of an image, and how each looks.
struct ImageFeatures {
  std::vector<cv::Vec2f> pixels;  ///< Column and row.
  cv::Mat_<float> descriptors;    ///< Of each a row, unit length.

  /// Saves or restores them, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(pixels, descriptors);
  }
};

/// Features (SIFT; Lowe 2004; RootSIFT, Arandjelovic and Zisserman 2012) of
/// the pixels of `mask` within `box`; all of one size. `most`: only so many, of
/// most contrast; 0: all.
ImageFeatures SiftFeatures(const cv::Mat_<std::uint8_t>& grey,
                           const cv::Rect& box,
                           const cv::Mat_<std::uint8_t>& mask, int most = 0);

/// Those whose pixels are in `mask`.
ImageFeatures FeaturesWithin(const ImageFeatures& features,
                             const cv::Mat_<std::uint8_t>& mask);

/// Which two features look alike.
struct Likeness {
  double reach;   ///< How far they may be apart, pixels.
  double ratio;   ///< The angle between them is below this fraction of that to
                  ///< the second best.
  double cosine;  ///< The angle's cosine is at least this.
};

/// Features that are most like each other, in both directions: indices of
/// `before` and `now`.
std::vector<std::pair<int, int>> AlikeFeatures(const ImageFeatures& before,
                                               const ImageFeatures& now,
                                               const Likeness& likeness);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_IMAGE_FEATURES_H_
