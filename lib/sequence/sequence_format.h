#ifndef SPLITFUSION_LIB_SEQUENCE_SEQUENCE_FORMAT_H_
#define SPLITFUSION_LIB_SEQUENCE_SEQUENCE_FORMAT_H_

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/base/registry.h"
#include "splitfusion/lib/sequence/association_list.h"

namespace splitfusion {

struct Calibration;

/// The layout of a kind of data sets: where the images of a sequence are and
/// what their pixels mean. ImageFolderReader reads by it. Thread-safe.
class SequenceFormat {
 public:
  virtual ~SequenceFormat() = default;

  /// What a folder holds by which it is recognised, for messages.
  virtual std::string Files() const = 0;

  /// Whether a folder looks like a sequence of this layout.
  virtual bool Recognises(const std::string& folder) const = 0;

  /// Colour and depth file of all frames, relative to the folder, in order.
  ///
  /// @throw InputError if there is none, or if a list is broken.
  virtual std::vector<AssociatedFiles> FindFrames(
      const std::string& folder) const = 0;

  /// Intrinsics and depth scale of a sequence; empty if nothing tells. Unless
  /// overridden that is what splitfusion::FindCalibration() finds.
  ///
  /// @throw InputError if a file of them is broken.
  virtual std::optional<Calibration> FindCalibration(
      const std::string& folder) const;

  /// A colour image, HxW 8UC3, BGR; unless overridden ReadColorImage().
  ///
  /// @throw InputError if the file cannot be read.
  virtual cv::Mat ReadColor(const std::string& path) const;

  /// A depth image, HxW 16UC1 in units of the depth scale, 0 = no measurement,
  /// registered to the colour; unless overridden ReadDepthImage().
  ///
  /// @throw InputError if the file cannot be read.
  virtual cv::Mat ReadDepth(const std::string& path) const;
};

/// Formats by name.
using FormatRegistry = Registry<SequenceFormat>;

/// tum and 7scenes.
FormatRegistry BuiltinFormats();

/// `name` itself, or for "auto" that of the first format that recognises the
/// folder.
///
/// @throw InputError if the name is unknown, the folder is not there or none
///     recognises it; lists the known ones.
std::string ResolveFormat(const std::string& name, const std::string& folder,
                          const FormatRegistry& formats);

/// The layout of the TUM RGB-D benchmark: `associations.txt`, or else `rgb.txt`
/// and `depth.txt` paired by time stamp; colour png or jpg; depth 16-bit PNG.
std::unique_ptr<SequenceFormat> MakeTumFormat();

/// The layout of the 7-Scenes data set: `frame-000000.color.png` and
/// `frame-000000.depth.png` in millimetres, 65535 where nothing was measured;
/// 30 frames a second. Without `calibration.txt` or `camera.txt` the intrinsics
/// are those that the authors give for depth, 585 585 320 240 at 640x480.
std::unique_ptr<SequenceFormat> MakeSevenScenesFormat();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_SEQUENCE_FORMAT_H_
