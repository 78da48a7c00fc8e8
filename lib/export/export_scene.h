#ifndef SPLITFUSION_LIB_EXPORT_EXPORT_SCENE_H_
#define SPLITFUSION_LIB_EXPORT_EXPORT_SCENE_H_

#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/export/export_surface.h"
#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// What of a run is exported, and how it lies.
struct ExportOptions {
  /// Every n-th frame, as of warped/.
  int every = 1;
  /// Ids of surfaces; empty: all.
  std::vector<int> surfaces;
  /// World of the run, or else the camera's frame in every frame.
  bool in_world = true;
  /// Right-handed with y up and z towards the viewer, as computer graphics has
  /// it; else x right, y down, z forward, as the run's files.
  bool y_up = false;
  /// Also parts of models that were refuted, as long as they were in use.
  bool refuted = true;
  /// Without triangles that are stretched in any frame.
  bool cut_stretched = true;

  /// @throw OptionError on `every` < 1.
  void Check() const;
};

/// One frame of an export.
struct ExportFrame {
  int index = 0;         ///< Frame index of the run.
  double timestamp = 0;  ///< Seconds, as the run has it.
  /// Space of the export from the camera's frame (x right, y down, z forward),
  /// metres.
  Rigid3d space_from_camera = Rigid3d::Identity();
  /// The same as the run estimated it, whatever the space of the export.
  Rigid3d world_from_camera = Rigid3d::Identity();
};

/// A run, as it is exported.
struct ExportScene {
  std::string run;                      ///< Its directory.
  bool y_up = false;                    ///< As of ExportOptions.
  bool in_world = true;                 ///< As of ExportOptions.
  std::vector<ExportFrame> frames;      ///< By index.
  std::optional<PinholeCamera> camera;  ///< If the run has its intrinsics.
  std::vector<ExportSurface> surfaces;  ///< By id, those of a surface in time.
  /// Names of surfaces without a vertex, or in none of the frames.
  std::vector<std::string> absent;

  /// Seconds since the first frame.
  double TimeOf(std::size_t place) const {
    return frames[place].timestamp - frames.front().timestamp;
  }
};

/// Reads a run. Of a surface that was re-anchored every model is one of its
/// own, and with ExportOptions::refuted so is every part that was refuted. A
/// surface is there from its birth, while the part of its model is in use, and
/// not where frames.jsonl says `inactive`.
///
/// @throw InputError if the folder holds no run, a file is broken, or there is
///     no surface or frame as asked for.
ExportScene ReadExportScene(const std::string& run,
                            const ExportOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_EXPORT_SCENE_H_
