#ifndef SPLITFUSION_LIB_SEQUENCE_LENS_DISTORTION_H_
#define SPLITFUSION_LIB_SEQUENCE_LENS_DISTORTION_H_

#include <array>
#include <opencv2/core.hpp>
#include <string>

#include "splitfusion/lib/geometry/camera.h"

namespace splitfusion {

/// Names of the coefficients of a LensDistortion, in their order.
constexpr std::array<const char*, 8> kDistortionKeys = {"k1", "k2", "p1", "p2",
                                                        "k3", "k4", "k5", "k6"};

/// Distortion of a lens as OpenCV defines it: Brown and Conrady's with three
/// radial and two tangential coefficients, or the rational one with six radial
/// ones. With (x, y) on the plane z = 1 and r^2 = x^2 + y^2 the lens shows
///
///   s = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
///   x' = s x + 2 p1 x y + p2 (r^2 + 2 x^2)
///   y' = s y + p1 (r^2 + 2 y^2) + 2 p2 x y
struct LensDistortion {
  /// k1 k2 p1 p2 k3 k4 k5 k6, the order of OpenCV.
  std::array<double, 8> coefficients{};

  /// Whether the lens is one of a pinhole camera.
  bool IsNone() const;

  /// Where the lens shows a point of the plane z = 1.
  cv::Point2d Distorted(const cv::Point2d& point) const;

  /// The coefficients, separated by blanks.
  std::string Text() const;

  /// @throw InputError if a coefficient is not a finite number.
  void Check() const;
};

/// Takes the distortion of one lens out of images: they become those of the
/// pinhole camera with the same intrinsics. Where each pixel comes from is
/// computed once. Thread-safe.
class Undistortion {
 public:
  /// `camera`: of the distorted images, and of those that come out.
  ///
  /// @throw InputError if fewer than a quarter of the pixels were seen through
  /// it.
  Undistortion(const PinholeCamera& camera, const LensDistortion& distortion);

  /// A colour image, HxW 8UC3: bilinear, black beyond the image.
  cv::Mat Color(const cv::Mat& image) const;

  /// A depth image, HxW 32FC1, 0 = none: the nearest pixel that has a
  /// measurement, within half the diagonal of one, since depths must not be
  /// mixed.
  cv::Mat_<float> Depth(const cv::Mat_<float>& depth) const;

  /// A mask, HxW 8UC1: nearest, 0 beyond the image.
  cv::Mat Mask(const cv::Mat& mask) const;

 private:
  cv::Mat_<cv::Vec2f> places_;  // In the distorted image, pixels.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_LENS_DISTORTION_H_
