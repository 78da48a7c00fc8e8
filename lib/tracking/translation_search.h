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
/// the points cover of the surface, less what they would hide behind it. What
/// speaks for a translation counts the less the farther it is, as a normal
/// deviation is less probable: half a body that is seen may look like its other
/// half. That chooses among places, each of which is a shift for which more
/// speaks than for its neighbours; it pulls at none of them.
///
/// Ours; the paper does not say how a surface is found again. The change of
/// depth is one for the whole surface, and its way in the image is taken at the
/// median depth of what is seen: a start for tracking, not a pose.
///
/// `samples`: of the surface as if nothing hid it, at every n-th pixel;
/// `deviation`: standard deviation of its place, metres > 0.
/// @return motion of the camera frame, metres; empty if nothing of the surface
///     is seen, or no translation explains more than it contradicts.
std::optional<Rigid3d> FindTranslation(const std::vector<ModelSample>& samples,
                                       const WarpField& warp,
                                       const LiveView& live,
                                       std::uint16_t surface, double deviation);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_TRANSLATION_SEARCH_H_
