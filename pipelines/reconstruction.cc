#include "splitfusion/pipelines/reconstruction.h"

#include <algorithm>
#include <optional>

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
  FindRollingShutter();
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

void Reconstruction::FindRollingShutter() {
  const std::optional<double> given = reader.options().rolling_shutter;
  if (given) return fusion.set_rolling_shutter(*given);
  const auto read = [&](int i) -> std::optional<Frame> {
    try {
      Frame frame = reader.Read(i);
      if (fusion.color_camera()) {
        RegisterFrame(fusion.camera(), *fusion.color_camera(), &frame);
      }
      return frame;
    } catch (const InputError&) {  // The run says so when it gets there.
      return std::nullopt;
    }
  };
  const RollingShutterEstimate estimate =
      EstimateRollingShutter(read, reader.size(), fusion.camera());
  if (!estimate.IsNeeded()) return;
  // The next image does not wait for its rows.
  fusion.set_rolling_shutter(std::min(estimate.seconds, estimate.interval));
  rows_note = estimate.Text();
}

}  // namespace splitfusion
