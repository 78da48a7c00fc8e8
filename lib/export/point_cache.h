#ifndef SPLITFUSION_LIB_EXPORT_POINT_CACHE_H_
#define SPLITFUSION_LIB_EXPORT_POINT_CACHE_H_

#include <cstddef>
#include <string>
#include <vector>

#include "splitfusion/lib/export/export_scene.h"

namespace splitfusion {

/// The files of one surface.
struct PointCacheFiles {
  std::string mesh;        ///< OBJ.
  std::string cache;       ///< PC2; empty if it stands still.
  std::size_t start = 0;   ///< Place of the cache's first frame in the export.
  std::size_t frames = 0;  ///< Of the cache.
};

/// Writes the vertices of every surface in every frame as a point cache
/// (PC2), `STEM_SURFACE.pc2`, and the mesh that it moves beside,
/// `STEM_SURFACE.obj`; of surfaces that stand still the mesh alone. A cache has
/// all frames from the first to the last in which the surface is there; where
/// it is not between these, its last ones stay. Vertices that no triangle uses
/// are in neither.
///
/// `stem`: path without its extension. `scene`: with ExportOptions::y_up.
/// @throw InputError if a file cannot be written.
std::vector<PointCacheFiles> WritePointCaches(const std::string& stem,
                                              const ExportScene& scene);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_POINT_CACHE_H_
