#ifndef SPLITFUSION_LIB_SEQUENCE_TUM_READER_H_
#define SPLITFUSION_LIB_SEQUENCE_TUM_READER_H_

#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/sequence/association_list.h"
#include "splitfusion/lib/sequence/calibration.h"
#include "splitfusion/lib/sequence/depth_filter.h"
#include "splitfusion/lib/sequence/sequence_reader.h"

namespace splitfusion {

/// How a sequence in TUM layout is read.
struct TumReaderOptions {
  int first_frame = 0;  ///< Frames before it are skipped; indices stay.
  int max_frames = 0;   ///< Frames read at most; 0 = all.
  /// Largest difference of time stamps, seconds; only without
  /// `associations.txt`.
  double association_tolerance = 0.02;
  /// Replaces the intrinsics of `calibration.txt` or `camera.txt`.
  std::optional<PinholeCamera> camera;
  /// Units a metre; replaces that of the file; 0 = as the file says.
  double depth_scale = 0;
  DepthFilterOptions depth_filter;  ///< Applied to every depth image.

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// Reads a sequence in TUM RGB-D layout: `associations.txt`, or else `rgb.txt`
/// and `depth.txt` paired by time stamp; colour png or jpg; depth 16-bit PNG,
/// registered to the colour; intrinsics from `calibration.txt`, `camera.txt`
/// or the options.
class TumReader : public SequenceReader {
 public:
  /// Reads the lists and the calibration of `folder`; images are read one by
  /// one in Next().
  ///
  /// @throw InputError if a list or the calibration is missing or broken, or
  ///     if no frame is left.
  explicit TumReader(const std::string& folder, TumReaderOptions options = {});

  const PinholeCamera& camera() const override { return calibration_.camera; }
  int size() const override { return static_cast<int>(pairs_.size()); }
  std::optional<Frame> Next() override;

  /// Stem of the depth file of the i-th frame that is read, 0..size() - 1.
  std::string Stem(int i) const;

  /// The same of the colour file.
  std::string ColorStem(int i) const;

  /// Files and time stamps of the frames that are read.
  const std::vector<AssociatedFiles>& pairs() const { return pairs_; }

  /// Next() goes on with the i-th frame that is read, 0..size().
  void SkipTo(int i) { next_ = i; }

  /// Intrinsics and depth scale in use.
  const Calibration& calibration() const { return calibration_; }

 private:
  void CheckSize(const std::string& path, const cv::Mat& image) const;

  std::string folder_;
  TumReaderOptions options_;
  Calibration calibration_;
  std::vector<AssociatedFiles> pairs_;  // Frames to be read.
  int next_ = 0;                        // Into pairs_.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_TUM_READER_H_
