#ifndef SPLITFUSION_PIPELINES_PREPARED_FRAME_H_
#define SPLITFUSION_PIPELINES_PREPARED_FRAME_H_

#include <optional>
#include <vector>

#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/sequence/color_camera.h"
#include "splitfusion/lib/sequence/frame.h"

namespace splitfusion {

/// A frame with all that can be known of it without the model.
struct PreparedFrame {
  Frame frame;    ///< As it was read, but for colour, which is registered.
  LiveView live;  ///< Points, normals, edges; no labels yet.
  std::vector<InstanceMask> detections;  ///< Of the segmenter.
  double read_seconds = 0;               ///< Spent on reading and on `live`.
  double segment_seconds = 0;            ///< Spent on `detections`.
};

/// Carries the colour of a frame, and masks of it if there are any, from the
/// pixels of an image that is not registered to those of the depth image.
void RegisterFrame(const PinholeCamera& camera, const ColorCamera& color_camera,
                   Frame* frame, std::vector<InstanceMask>* masks = nullptr);

/// Prepares one frame; `segmenter` may be null. `color_camera`: of colour
/// images that are not registered; colour and masks, which are found in it as
/// it is, are carried over to the pixels of the depth image.
///
/// @throw InputError if an image does not fit the camera, and what the
/// segmenter throws.
PreparedFrame PrepareFrame(const PinholeCamera& camera, Frame frame,
                           const PointMapOptions& options, Segmenter* segmenter,
                           const std::optional<ColorCamera>& color_camera = {});

/// Makes the images of a frame be as if all rows had been exposed with the
/// middle one, see RollingShutter. `motion`: of points that stand still in the
/// camera frame, from the frame before; `share`: of the time since then that
/// the rows take. Nothing is labelled yet.
void UnrollFrame(const Rigid3d& motion, double share,
                 const PointMapOptions& options, PreparedFrame* prepared);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_PREPARED_FRAME_H_
