#ifndef SPLITFUSION_LIB_EVALUATION_LIVE_IMAGES_H_
#define SPLITFUSION_LIB_EVALUATION_LIVE_IMAGES_H_

#include <cstdint>
#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <string>

#include "splitfusion/lib/evaluation/recorded_run.h"

namespace splitfusion {

class ImageFolderReader;

/// STEM.png of a folder of images of ids, HxW; empty if there is no such file.
///
/// @throw InputError if it is broken, or not of the camera's size.
cv::Mat_<std::uint16_t> ReadIds(const std::string& folder,
                                const RecordedFrame& frame,
                                const PinholeCamera& camera);

/// Pixels of every id, those with depth if `live` is not null.
std::map<int, int> CountPixels(const cv::Mat_<std::uint16_t>& ids,
                               const cv::Mat_<float>* live);

/// What the camera measured in the frames of a run: the depth images of the
/// sequence that options.flags names, and the masks of the run. Images are read
/// when they are asked for; thread-safe.
class LiveImages {
 public:
  /// Reads the lists and the calibration of the sequence.
  ///
  /// @throw InputError if the run does not say where the sequence is or has no
  ///     camera, or if a list or the calibration is missing or broken.
  explicit LiveImages(const RecordedRun& run);

  /// Intrinsics of all images.
  const PinholeCamera& camera() const;

  /// Depth as measured, HxW, metres, 0 = none.
  ///
  /// @throw InputError if the image is missing or broken, or if the sequence
  ///     has another image there than the run.
  cv::Mat_<float> Depth(const RecordedFrame& frame) const;

  /// The same after the filter that the run applied.
  cv::Mat_<float> FilteredDepth(const RecordedFrame& frame) const;

  /// Surface ids of the pixels, RUN/masks/STEM.png, HxW.
  ///
  /// @throw InputError if it is missing or broken.
  cv::Mat_<std::uint16_t> Mask(const RecordedFrame& frame) const;

 private:
  std::string run_;
  std::string sequence_;
  DepthOptions filter_;
  std::shared_ptr<const ImageFolderReader> reader_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_LIVE_IMAGES_H_
