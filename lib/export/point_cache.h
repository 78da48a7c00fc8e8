#ifndef SPLITFUSION_LIB_EXPORT_POINT_CACHE_H_
#define SPLITFUSION_LIB_EXPORT_POINT_CACHE_H_

#include <string>
#include <vector>

#include "splitfusion/lib/export/export_scene.h"

namespace splitfusion {

/// Writes the vertices of every surface in every frame as a point cache
/// (PC2), `STEM_SURFACE.pc2`, and the mesh that it moves beside,
/// `STEM_SURFACE.obj`; of surfaces that stand still the mesh alone. A cache has
/// all frames from the first to the last in which the surface is there; where
/// it is not between these, its last ones stay. Returns the files.
///
/// `stem`: path without its extension. `scene`: with ExportOptions::y_up.
/// @throw InputError if a file cannot be written.
std::vector<std::string> WritePointCaches(const std::string& stem,
                                          const ExportScene& scene);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_POINT_CACHE_H_
