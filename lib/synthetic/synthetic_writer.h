#ifndef SPLITFUSION_LIB_SYNTHETIC_SYNTHETIC_WRITER_H_
#define SPLITFUSION_LIB_SYNTHETIC_SYNTHETIC_WRITER_H_

#include <functional>
#include <string>
#include <vector>

#include "splitfusion/lib/synthetic/synthetic_options.h"

namespace splitfusion {

/// How a synthetic sequence is written.
struct SyntheticWriterOptions {
  int mesh_every = 25;     ///< Frames between the posed meshes of the truth.
  int seen_every = 5;      ///< Frames between the samples that `seen` counts.
  bool overwrite = false;  ///< Replace a sequence of this writer.

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// Renders a sequence and writes it in the TUM RGB-D layout, with detections in
/// `masks_noisy/` and the exact truth in `gt/` (docs/synthetic_sequences.md).
///
/// The folder is written under a temporary name beside `directory` and put in
/// place at the end: a failure leaves nothing behind and an old sequence
/// untouched. `sf_synth.json` in it lists what was written, and an old
/// sequence's files are deleted by that list only; files of others that were
/// beside them stay, and their paths are returned.
///
/// `progress`, if given, is called after every frame with their number so far.
///
/// @throw InputError if an option is out of its range; if `directory` exists
///     and is not empty, unless `overwrite` is set and it is such a sequence,
///     unchanged; or if a file cannot be written.
std::vector<std::string> WriteSyntheticSequence(
    const SyntheticOptions& options,
    const SyntheticWriterOptions& writer_options, const std::string& directory,
    const std::function<void(int)>& progress = {});

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_SYNTHETIC_WRITER_H_
