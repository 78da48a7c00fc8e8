#include "splitfusion/pipelines/prepared_frame.h"

#include <utility>

#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/frame/color_registration.h"

namespace splitfusion {

namespace {

/// Carries colour and masks over to the pixels of the depth image.
void Register(const PinholeCamera& camera, const ColorCamera& color_camera,
              Frame* frame, std::vector<InstanceMask>* detections) {
  const cv::Mat_<cv::Vec2f> places =
      ColorPlaces(camera, color_camera, frame->depth);
  frame->color = RegisterColor(frame->color, places);
  for (InstanceMask& detection : *detections) {
    detection.mask = RegisterMask(detection.mask, places);
  }
}

}  // namespace

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
    Register(camera, *color_camera, &frame, &prepared.detections);
  }
  prepared.live = MakeLiveView(camera, frame.depth, frame.color, options);
  prepared.read_seconds = stopwatch.Restart();
  prepared.frame = std::move(frame);
  return prepared;
}

}  // namespace splitfusion
