#ifndef SPLITFUSION_LIB_TRACKING_IMAGE_SHIFT_H_
#define SPLITFUSION_LIB_TRACKING_IMAGE_SHIFT_H_

#include <cstdint>
#include <optional>

#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// Finds a surface again that was lost: the translation under which its
/// rendering explains its live pixels best. All shifts of the image are
/// compared, by cross-correlation, so that neither a far jump nor a half hidden
/// surface misleads it, as both mislead the centroid; the depth follows from
/// the pixels that are explained then.
///
/// `model`: depth of the surface alone, HxW of every n-th live pixel, metres,
/// 0 = nothing.
/// @return camera from camera; empty if no shift explains at least 0.3 of the
///     live pixels, or of the model's if they are fewer.
std::optional<Rigid3d> FindImageShift(const cv::Mat_<float>& model,
                                      const LiveView& live,
                                      std::uint16_t surface);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_IMAGE_SHIFT_H_
