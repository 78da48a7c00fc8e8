#ifndef SPLITFUSION_LIB_FRAME_DEPTH_EDGES_H_
#define SPLITFUSION_LIB_FRAME_DEPTH_EDGES_H_

#include <cstdint>

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {

/// Jump of depth between pixels `step` apart that is an edge: more than noise
/// or a surface seen at 79 degrees (tan = 5) gives. Metres; the focal length in
/// pixels.
inline float EdgeJump(float depth, int step, float focal_length,
                      const DepthNoise& noise) {
  constexpr DepthTolerance<float> kNoise = {0.005f};
  constexpr float kSlope = 5;
  return kNoise.At(depth, noise) + kSlope * depth * step / focal_length;
}

/// Pixels beyond the image that MarkEdges() reads, on every side.
constexpr int kEdgeBorder = 2;  // Layout.

/// Marks the pixels of a row that are next to a jump of depth, by 255; others
/// become 0. One and two pixels away: edges come with a column of holes.
///
/// `depth`: the row in an image of metres, 0 = none, with a border of zeros of
/// kEdgeBorder pixels; `stride` its pixels from one row to the next.
void MarkEdges(const float* depth, int stride, int width, float focal_length,
               const DepthNoise& noise, std::uint8_t* edges);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_FRAME_DEPTH_EDGES_H_
