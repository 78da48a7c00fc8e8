#ifndef SPLITFUSION_LIB_FRAME_LIVE_VIEW_H_
#define SPLITFUSION_LIB_FRAME_LIVE_VIEW_H_

#include <array>
#include <cstdint>
#include <map>
#include <opencv2/core.hpp>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/point_map.h"

namespace splitfusion {

/// Smoothed grey values of an image and their derivatives, HxW.
struct GreyLevel {
  cv::Mat_<float> value;         ///< 0..1.
  cv::Mat_<cv::Vec2f> gradient;  ///< By column and row, 1 / pixel.
};

/// Smoothing of the fine and the coarse level, pixels: the coarse one reaches
/// as far as things move between frames.
constexpr double kGreySigma[2] = {1.2, 4.0};

/// The live frame as association and fusion see it; all images HxW.
struct LiveView {
  /// Intrinsics of all images.
  PinholeCamera camera;
  PointMap map;                    ///< Points and normals, camera frame.
  cv::Mat color;                   ///< 8UC3, BGR.
  std::array<GreyLevel, 2> grey;   ///< Fine and coarse.
  cv::Mat_<float> depth;           ///< Metres, 0 = none; pinholes filled.
  cv::Mat_<float> confidence;      ///< (sigma_0 / sigma(z))^2 at most 1, times
                                   ///< the cosine of the viewing angle.
  cv::Mat_<std::uint8_t> edges;    ///< 255 within 2 px of a depth edge.
  cv::Mat_<std::uint16_t> labels;  ///< Surface id of every pixel.
  cv::Mat_<std::uint8_t> uncertain;  ///< 255: belongs to no surface for sure.
};

/// Grey value of a BGR colour, 0..1.
inline float Intensity(const cv::Vec3b& bgr) {
  return (0.114f * bgr[0] + 0.587f * bgr[1] + 0.299f * bgr[2]) / 255;  // Unit.
}

/// Builds points, normals, confidence and edges of a frame. Labels and
/// `uncertain` start as background everywhere and certain.
///
/// `depth` 32FC1 metres, `color` 8UC3, both of the camera's size.
/// @throw InputError if a type or size does not fit.
LiveView MakeLiveView(const PinholeCamera& camera, const cv::Mat& depth,
                      const cv::Mat& color,
                      const PointMapOptions& options = {});

/// Whether a pixel shows a surface for sure: it has depth, is one of the
/// surface, and neither uncertain nor beside a depth edge.
inline bool IsCertain(const LiveView& live, int surface, int v, int u) {
  return live.labels(v, u) == surface && live.depth(v, u) > 0 &&
         live.edges(v, u) == 0 && live.uncertain(v, u) == 0;
}

/// Number of pixels with depth of every surface id that has some.
std::map<int, int> PixelsOfSurfaces(const LiveView& live);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_FRAME_LIVE_VIEW_H_
