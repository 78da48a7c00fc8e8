#ifndef SPLITFUSION_LIB_SEQUENCE_SEQUENCE_FORMAT_H_
#define SPLITFUSION_LIB_SEQUENCE_SEQUENCE_FORMAT_H_

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/base/registry.h"
#include "splitfusion/lib/sequence/association_list.h"
#include "splitfusion/lib/sequence/image_header.h"
#include "splitfusion/lib/sequence/trajectory.h"

namespace splitfusion {

struct Calibration;

/// The layout of a kind of data sets: where the images of a sequence are and
/// what their pixels mean. ImageFolderReader reads by it. Thread-safe.
///
/// A sequence is a folder of image files; or it is a file that holds all, such
/// as `scene.sens`. The images in that have names as if it was a folder,
/// `scene.sens/000000.jpg`, and the format overrides what reads them.
class SequenceFormat {
 public:
  virtual ~SequenceFormat() = default;

  /// What a sequence holds by which it is recognised, for messages.
  virtual std::string Files() const = 0;

  /// Whether a folder or file looks like a sequence of this layout.
  virtual bool Recognises(const std::string& sequence) const = 0;

  /// Colour and depth file of all frames, relative to the sequence, in order.
  ///
  /// @throw InputError if there is none, or if a list is broken.
  virtual std::vector<AssociatedFiles> FindFrames(
      const std::string& sequence) const = 0;

  /// Intrinsics and depth scale of a sequence; empty if nothing tells. A size
  /// of 0 stands for that of the first depth image, a depth scale of 0 for one
  /// that is not known. Unless overridden that is what
  /// splitfusion::FindCalibration() or else FindForeignCalibration() finds.
  ///
  /// @throw InputError if a file of them is broken.
  virtual std::optional<Calibration> FindCalibration(
      const std::string& sequence) const;

  /// Poses of the depth camera that come with a sequence, at the time stamps of
  /// `frames`, which FindFrames() found, or near them; empty if there are none.
  /// Unless overridden those of `groundtruth.txt`, TUM text.
  ///
  /// @throw InputError if a file of them is broken.
  virtual Trajectory FindPoses(
      const std::string& sequence,
      const std::vector<AssociatedFiles>& frames) const;

  /// What a colour image says of itself before it is decoded; empty if unknown.
  /// Unless overridden ReadImageHeader().
  ///
  /// @throw InputError if the file is missing or shows to be broken.
  virtual std::optional<ImageHeader> ReadColorHeader(
      const std::string& path) const;

  /// The same of a depth image; unless overridden ReadDepthHeader().
  ///
  /// @throw InputError if the file is missing or shows to be broken.
  virtual std::optional<ImageHeader> ReadDepthHeader(
      const std::string& path) const;

  /// A colour image, HxW 8UC3, BGR; unless overridden ReadColorImage().
  ///
  /// @throw InputError if the file cannot be read.
  virtual cv::Mat ReadColor(const std::string& path) const;

  /// A depth image, HxW, 0 = no measurement: 16UC1 in units of the depth scale,
  /// or 32FC1 in metres; unless overridden ReadDepthImage().
  ///
  /// @throw InputError if the file cannot be read.
  virtual cv::Mat ReadDepth(const std::string& path) const;
};

/// Formats by name.
using FormatRegistry = Registry<SequenceFormat>;

/// Those of the headers `*_formats.h`.
FormatRegistry BuiltinFormats();

/// `name` itself, or for "auto" that of the first format that recognises the
/// sequence.
///
/// @throw InputError if the name is unknown, the sequence is not there or none
///     recognises it; lists the known ones.
std::string ResolveFormat(const std::string& name, const std::string& sequence,
                          const FormatRegistry& formats);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_SEQUENCE_FORMAT_H_
