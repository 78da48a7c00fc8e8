#ifndef SPLITFUSION_LIB_SEQUENCE_IMAGE_FOLDER_READER_H_
#define SPLITFUSION_LIB_SEQUENCE_IMAGE_FOLDER_READER_H_

#include <map>
#include <memory>
#include <mutex>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/sequence/calibration.h"
#include "splitfusion/lib/sequence/frame.h"
#include "splitfusion/lib/sequence/reader_options.h"
#include "splitfusion/lib/sequence/sequence_format.h"

namespace splitfusion {

/// A frame that is not there or cannot be used.
struct BadFrame {
  int index = 0;       ///< In the sequence.
  std::string stem;    ///< Of the depth file.
  std::string reason;  ///< One line that names the file.
};

/// Reads a sequence of image files, laid out in one of the known formats. What
/// it gives has no lens distortion.
class ImageFolderReader {
 public:
  /// Finds frames and calibration of `folder`, which may be a file if the
  /// format is one of files; images are read one by one in Next(). With
  /// `skip_bad_frames` FindBadFrames() are left out. `formats`: what the
  /// options may name, not kept.
  ///
  /// @throw InputError if the format is not known, if a list or the calibration
  ///     is missing or broken, or if no frame is left.
  explicit ImageFolderReader(const std::string& folder,
                             ReaderOptions options = {},
                             const FormatRegistry& formats = BuiltinFormats());

  /// Intrinsics of every frame.
  const PinholeCamera& camera() const { return calibration_.camera; }
  /// Size of the colour images, that of a colour camera apart if there is one.
  cv::Size color_size() const;
  /// Takes the distortion out of what was made from colour files as they are,
  /// such as masks; null if they have none.
  std::shared_ptr<const Undistortion> color_undistortion() const {
    return color_undistortion_;
  }
  /// Number of frames that Next() gives in all; fewer if `skip_bad_frames` and
  /// images turn out to be broken in Next().
  int size() const;
  /// The next frame in order of time; empty after the last one.
  ///
  /// @throw InputError on a missing or broken image; names the file.
  std::optional<Frame> Next();

  /// The i-th frame, 0..size() - 1, whatever Next() gives next.
  ///
  /// @throw InputError on a missing or broken image; names the file.
  Frame Read(int i) const;

  /// Colour of the i-th frame, color_size(), 8UC3, BGR.
  ///
  /// @throw InputError on a missing or broken image; names the file.
  cv::Mat ReadColor(int i) const;

  /// Depth of the i-th frame, HxW, metres, 0 = none, unfiltered.
  ///
  /// @throw InputError on a missing or broken image; names the file.
  cv::Mat_<float> ReadDepth(int i) const;

  /// Poses of the depth camera that come with the sequence, see
  /// SequenceFormat::FindPoses(); of all of its frames, or near them.
  ///
  /// @throw InputError if a file of them is broken.
  Trajectory FindSequencePoses() const;

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

  /// What is wrong with the time stamps, one line; empty if they ascend. All
  /// that is known of velocities comes from them.
  std::string TimesNote() const;

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
  /// How it is read, as it was given, but for the format that "auto" found.
  const ReaderOptions& options() const { return options_; }
  /// Intrinsics, depth scale, colour camera and lenses in use.
  const Calibration& calibration() const { return calibration_; }

 private:
  cv::Size ExpectedSize() const;
  std::string ColorPath(int i) const;
  std::string DepthPath(int i) const;
  /// Fills in what the calibration lacks, and checks it.
  void CompleteCalibration();
  /// @throw InputError if the images of the i-th frame cannot be used.
  void CheckFiles(int i) const;
  std::optional<Frame> ReadOrSkip();
  /// @throw InputError if no frame is left.
  void SkipBadFrames();
  /// @throw InputError if a frame has no pose in options_.trajectory.
  void FindPoses();
  /// Leaves out the i-th frame.
  void Skip(int i, const std::string& reason);

  std::string folder_;
  ReaderOptions options_;
  std::shared_ptr<const SequenceFormat> format_;
  Calibration calibration_;
  std::shared_ptr<const Undistortion> color_undistortion_;
  std::shared_ptr<const Undistortion> depth_undistortion_;
  std::vector<AssociatedFiles> pairs_;  // Frames to be read.
  std::vector<int> indices_;            // Of pairs_, in the sequence.
  std::map<int, Rigid3d> poses_;        // Given ones, by index.
  std::vector<BadFrame> skipped_;
  mutable std::mutex mutex_;  // Of the lists above.
  int next_ = 0;              // Into pairs_.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_IMAGE_FOLDER_READER_H_
