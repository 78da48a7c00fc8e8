#ifndef SPLITFUSION_LIB_SEQUENCE_SEQUENCE_READER_H_
#define SPLITFUSION_LIB_SEQUENCE_SEQUENCE_READER_H_

#include <optional>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/sequence/frame.h"

namespace splitfusion {

/// Source of RGB-D frames in order of time.
class SequenceReader {
 public:
  virtual ~SequenceReader() = default;

  /// Intrinsics of every frame.
  virtual const PinholeCamera& camera() const = 0;

  /// Number of frames that Next() gives in all.
  virtual int size() const = 0;

  /// The next frame; empty after the last one.
  ///
  /// @throw InputError on a missing or broken image; names the file.
  virtual std::optional<Frame> Next() = 0;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_SEQUENCE_READER_H_
