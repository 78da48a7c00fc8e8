#include "splitfusion/pipelines/reconstruction.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/calibration/color_camera_estimate.h"
#include "splitfusion/lib/calibration/rolling_shutter_estimate.h"

namespace splitfusion {
namespace {

/// `reader` itself.
const ImageFolderReader& Checked(const ImageFolderReader& reader) {
  if (!reader.options().skip_bad_frames) reader.CheckFrames();
  return reader;
}

/// Takes the depth of what moves by itself off a frame.
void LeaveNonRigidOut(const std::vector<InstanceMask>& masks,
                      const LabelTable& labels, Frame* frame) {
  for (const InstanceMask& one : masks) {
    if (labels.Kind(one.class_name) != SurfaceKind::kNonRigid) continue;
    frame->depth.setTo(0, one.mask);
  }
}

}  // namespace

Reconstruction::Reconstruction(const std::string& sequence,
                               const ReaderOptions& reading,
                               const PipelineOptions& options,
                               const LabelTable& labels,
                               const SegmenterMaker& segmenter,
                               const Registries& registries)
    : reader(sequence, reading, registries.formats),
      fusion(Checked(reader).camera(), options, labels, segmenter(reader),
             registries) {
  FindColorCamera();
  FindRollingShutter(labels);
}

void Reconstruction::FindColorCamera() {
  fusion.set_color_camera(reader.calibration().color);
  if (reader.calibration().color || reader.options().color_camera != "auto") {
    return;
  }
  const ColorCameraEstimate estimate = EstimateColorCamera(reader);
  if (!estimate.IsNeeded()) return;
  fusion.set_color_camera(estimate.camera);
  note = estimate.Text();
}

void Reconstruction::FindRollingShutter(const LabelTable& labels) {
  const std::optional<double> given = reader.options().rolling_shutter;
  if (given) return fusion.set_rolling_shutter(*given);
  std::mutex segmenting;
  const auto estimated = [&](Segmenter* segmenter) {
    const auto read = [&](int i) -> std::optional<Frame> {
      try {
        Frame frame = reader.Read(i);
        std::vector<InstanceMask> masks;
        if (segmenter != nullptr) {
          const std::lock_guard<std::mutex> lock(segmenting);
          masks = segmenter->Preview(frame);
        }
        if (fusion.color_camera()) {
          RegisterFrame(fusion.camera(), *fusion.color_camera(), &frame,
                        &masks);
        }
        LeaveNonRigidOut(masks, labels, &frame);
        return frame;
      } catch (const InputError&) {  // The run says so when it gets there.
        return std::nullopt;
      }
    };
    return EstimateRollingShutter(read, reader.size(), fusion.camera());
  };
  // Somebody who walks by looks like a camera that turns. Masks may take long,
  // so they are asked for where something was found.
  RollingShutterEstimate estimate = estimated(nullptr);
  if (!estimate.IsNeeded()) return;
  if (fusion.segmenter() != nullptr) estimate = estimated(fusion.segmenter());
  if (!estimate.IsNeeded()) return;
  // The next image does not wait for its rows.
  fusion.set_rolling_shutter(std::min(estimate.seconds, estimate.interval));
  rows_note = estimate.Text();
}

}  // namespace splitfusion
