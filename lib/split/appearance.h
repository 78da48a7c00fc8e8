#ifndef SPLITFUSION_LIB_SPLIT_APPEARANCE_H_
#define SPLITFUSION_LIB_SPLIT_APPEARANCE_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// Colours and place of some pixels, by which a surface is recognised.
struct Appearance {
  cv::Mat histogram;  ///< 8x8x8 BGR, sum 1; empty if nothing was seen.
  double pixels = 0;  ///< That the histogram is made of.
  /// Mean point, world, metres.
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  bool placed = false;  ///< Whether any pixel had depth.
  int identity = 0;     ///< If it is given, see InstanceMask; 0 = it is not.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(histogram, pixels, center, placed, identity);
  }
};

/// Appearance of the pixels inside of `mask` (HxW, 255 inside).
Appearance ComputeAppearance(const cv::Mat& color, const PointMap& points,
                             const cv::Mat_<uchar>& mask,
                             const Rigid3d& world_from_camera);

/// Takes one more view into the appearance of a surface: colours are means over
/// all its pixels so far, so that a strip beside an occluder tells little; the
/// place is that of the view.
void AddView(const Appearance& view, Appearance* appearance);

/// 0..1: intersection of the histograms; neither may be empty.
double ColorSimilarity(const Appearance& a, const Appearance& b);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_APPEARANCE_H_
