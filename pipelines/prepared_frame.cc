#include "splitfusion/pipelines/prepared_frame.h"

#include <Eigen/Geometry>
#include <utility>

#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/frame/color_registration.h"
#include "splitfusion/lib/frame/rolling_shutter.h"

namespace splitfusion {
namespace {

/// Takes colour and masks from `places`.
void TakeFrom(const cv::Mat_<cv::Vec2f>& places, Frame* frame,
              std::vector<InstanceMask>* masks) {
  frame->color = RegisterColor(frame->color, places);
  if (masks == nullptr) return;
  for (InstanceMask& mask : *masks) {
    mask.mask = RegisterMask(mask.mask, places);
  }
}

}  // namespace

void RegisterFrame(const PinholeCamera& camera, const ColorCamera& color_camera,
                   Frame* frame, std::vector<InstanceMask>* masks) {
  TakeFrom(ColorPlaces(camera, color_camera, frame->depth), frame, masks);
}

PreparedFrame PrepareFrame(const PinholeCamera& camera, Frame frame,
                           const PointMapOptions& options, Segmenter* segmenter,
                           const std::optional<ColorCamera>& color_camera) {
  PreparedFrame prepared;
  Stopwatch stopwatch;
  if (segmenter != nullptr) {
    prepared.detections = segmenter->Segment(frame);
    prepared.segment_seconds = stopwatch.Restart();
  }
  if (color_camera) {
    RegisterFrame(camera, *color_camera, &frame, &prepared.detections);
  }
  prepared.live = MakeLiveView(camera, frame.depth, frame.color, options);
  prepared.read_seconds = stopwatch.Restart();
  prepared.frame = std::move(frame);
  return prepared;
}

void UnrollFrame(const Rigid3d& motion, double share,
                 const PointMapOptions& options, PreparedFrame* prepared) {
  Rigid3d of_rows = Rigid3d::Identity();
  const Eigen::AngleAxisd turn(motion.linear());
  of_rows.linear() =
      Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
  of_rows.translation() = share * motion.translation();
  Frame& frame = prepared->frame;
  const RollingShutter shutter(frame.depth, prepared->live.camera, of_rows);
  TakeFrom(shutter.places(), &frame, &prepared->detections);
  frame.depth = shutter.Depth();
  prepared->live =
      MakeLiveView(prepared->live.camera, frame.depth, frame.color, options);
}

}  // namespace splitfusion
