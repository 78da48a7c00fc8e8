#ifndef SPLITFUSION_LIB_TRACKING_TRANSLATION_SEARCH_H_
#define SPLITFUSION_LIB_TRACKING_TRANSLATION_SEARCH_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// Finds a surface again that was lost or hidden: the translation under which
/// most of its points agree with live points of the surface, in depth, normal
/// and grey value. All shifts of the image are compared, and for each of them
/// all changes of depth (a Hough transform over the three), so that neither a
/// far jump, nor a half hidden surface, nor limbs that have moved mislead it,
/// as they mislead centroids and silhouettes. The silhouette counts half: what
/// the points cover of the surface, less what they would hide behind it.
///
/// Ours; the paper does not say how a surface is found again. The change of
/// depth is one for the whole surface, and its way in the image is taken at the
/// median depth of what is seen: a start for tracking, not a pose.
///
/// `samples`: of the surface as if nothing hid it, at every n-th pixel.
/// @return motion of the camera frame, metres; empty if nothing of the surface
/// is seen, or no
///     translation explains more than it contradicts.
std::optional<Rigid3d> FindTranslation(const std::vector<ModelSample>& samples,
                                       const WarpField& warp,
                                       const LiveView& live,
                                       std::uint16_t surface);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_TRANSLATION_SEARCH_H_
