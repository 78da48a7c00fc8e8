#include "splitfusion/pipelines/reconstruction.h"

#include "splitfusion/lib/calibration/color_camera_estimate.h"

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
  fusion.set_color_camera(reader.calibration().color);
  if (reader.calibration().color || reading.color_camera != "auto") return;
  const ColorCameraEstimate estimate = EstimateColorCamera(reader);
  if (!estimate.IsNeeded()) return;
  fusion.set_color_camera(estimate.camera);
  note = estimate.Text();
}

}  // namespace splitfusion
