#ifndef SPLITFUSION_LIB_SEQUENCE_TUM_READER_H_
#define SPLITFUSION_LIB_SEQUENCE_TUM_READER_H_

#include <mutex>
#include <opencv2/core.hpp>
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
  /// Frames whose images are missing or broken are left out; indices stay.
  bool skip_bad_frames = false;

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// A frame that is not there or cannot be used.
struct BadFrame {
  int index = 0;       ///< In the sequence.
  std::string stem;    ///< Of the depth file.
  std::string reason;  ///< One line that names the file.
};

/// Reads a sequence in TUM RGB-D layout: `associations.txt`, or else `rgb.txt`
/// and `depth.txt` paired by time stamp; colour png or jpg; depth 16-bit PNG,
/// registered to the colour; intrinsics from `calibration.txt`, `camera.txt`
/// or the options.
class TumReader : public SequenceReader {
 public:
  /// Reads the lists and the calibration of `folder`; images are read one by
  /// one in Next(). With `skip_bad_frames` FindBadFrames() are left out.
  ///
  /// @throw InputError if a list or the calibration is missing or broken, or
  ///     if no frame is left.
  explicit TumReader(const std::string& folder, TumReaderOptions options = {});

  const PinholeCamera& camera() const override { return calibration_.camera; }
  /// Fewer if `skip_bad_frames` and images turn out to be broken in Next().
  int size() const override;
  std::optional<Frame> Next() override;

  /// Looks at the files of all frames, without decoding them: that they are
  /// there, whole as far as their headers and ends show, and of the right size
  /// and type. Thousands a second. Returns those that are not, in order.
  std::vector<BadFrame> FindBadFrames() const;

  /// @throw InputError if FindBadFrames() finds any: the first of them, and how
  ///     many more there are.
  void CheckFrames() const;

  /// Frames left out with `skip_bad_frames`, by index: what FindBadFrames()
  /// found at the start, and whose decoding failed so far. May be called while
  /// Next() runs on another thread.
  std::vector<BadFrame> skipped() const;

  /// Stem of the depth file of the i-th frame that is read, 0..size() - 1.
  std::string Stem(int i) const;

  /// The same of the colour file.
  std::string ColorStem(int i) const;

  /// Files and time stamps of the frames that are read.
  const std::vector<AssociatedFiles>& pairs() const { return pairs_; }

  /// Next() goes on with the i-th frame that is read, 0..size(). With
  /// `skip_bad_frames` those before are decoded, to know which of them count.
  void SkipTo(int i);

  /// The sequence, as it was given.
  const std::string& folder() const { return folder_; }
  /// How it is read, as it was given.
  const TumReaderOptions& options() const { return options_; }
  /// Intrinsics and depth scale in use.
  const Calibration& calibration() const { return calibration_; }

 private:
  cv::Size ExpectedSize() const;
  /// @throw InputError if the images of the i-th frame cannot be used.
  void CheckFiles(int i) const;
  Frame Read(int i) const;
  std::optional<Frame> ReadOrSkip();
  /// Leaves out the i-th frame.
  void Skip(int i, const std::string& reason);

  std::string folder_;
  TumReaderOptions options_;
  Calibration calibration_;
  std::vector<AssociatedFiles> pairs_;  // Frames to be read.
  std::vector<int> indices_;            // Of pairs_, in the sequence.
  std::vector<BadFrame> skipped_;
  mutable std::mutex mutex_;  // Of the lists above.
  int next_ = 0;              // Into pairs_.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_TUM_READER_H_
