#include "splitfusion/pipelines/prepared_frame.h"

#include <utility>

#include "splitfusion/lib/base/stopwatch.h"

namespace splitfusion {

PreparedFrame PrepareFrame(const PinholeCamera& camera, Frame frame,
                           const PointMapOptions& options,
                           Segmenter* segmenter) {
  PreparedFrame prepared;
  Stopwatch stopwatch;
  prepared.live = MakeLiveView(camera, frame.depth, frame.color, options);
  prepared.read_seconds = stopwatch.Restart();
  if (segmenter != nullptr) {
    prepared.detections = segmenter->Segment(frame);
    prepared.segment_seconds = stopwatch.Restart();
  }
  prepared.frame = std::move(frame);
  return prepared;
}

}  // namespace splitfusion
