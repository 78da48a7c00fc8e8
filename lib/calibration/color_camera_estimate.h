#ifndef SPLITFUSION_LIB_CALIBRATION_COLOR_CAMERA_ESTIMATE_H_
#define SPLITFUSION_LIB_CALIBRATION_COLOR_CAMERA_ESTIMATE_H_

#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/sequence/color_camera.h"
#include "splitfusion/lib/sequence/frame.h"
#include "splitfusion/lib/sequence/image_folder_reader.h"

namespace splitfusion {

/// What the images say of where the colour camera is.
struct ColorCameraEstimate {
  ColorCamera camera;  ///< As estimated.
  /// Frames that had edges enough.
  int frames = 0;
  /// Strength of the colour's edges at the depth's edges, in units of their
  /// mean over the image, as if the images were registered ...
  double strength_before = 0;
  /// ... and with the estimate: means over the frames.
  double strength_after = 0;
  /// Median distance between a depth edge's place in the colour image with the
  /// estimate and as if registered, pixels.
  double shift = 0;

  /// Whether the images are certainly not registered: with the estimate, colour
  /// at the edges of depth is 1.9 times as strong as without, and it moves them
  /// by more than the 3 pixels that structured light puts them off. Of images
  /// that are registered some other camera fits a little better, too: the same
  /// one in every frame if the camera stands, or if it turns one way and the
  /// colour is some milliseconds late.
  bool IsNeeded() const;
  /// One line for people.
  std::string Text() const;
};

/// Estimates intrinsics (one focal length) and pose of the colour camera: where
/// depth jumps, the colour image has an edge most of the time. Every near side
/// of a depth edge is a point X of the depth camera; with C the strength of the
/// colour's edges (gradient over its mean around, at most kStrongest),
///
///   min over R, t, s of  sum over frames and X of [kStrongest - C(pi(R X +
///   t))]^2
///
/// where pi has s times the focal length of the depth camera, R and t are held
/// near to registered images by how cameras are built, and C is blurred, ever
/// less. Found by a search over shifts and focal lengths, then by Ceres. After
/// Levinson and Thrun, Automatic Online Calibration of Cameras and Lasers, RSS
/// 2013, who align edges of laser ranges likewise. The scene may move; the
/// camera may stand still.
///
/// `frames`: some of a sequence, each of the camera's size; the more differ in
/// what they show, the better. Same frames, same bytes.
ColorCameraEstimate EstimateColorCamera(const std::vector<Frame>& frames,
                                        const PinholeCamera& camera);

/// The same of frames spread over a sequence, those that can be read.
ColorCameraEstimate EstimateColorCamera(const ImageFolderReader& reader);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_CALIBRATION_COLOR_CAMERA_ESTIMATE_H_
