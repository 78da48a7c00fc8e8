#ifndef SPLITFUSION_LIB_EXPORT_GLTF_SCENE_H_
#define SPLITFUSION_LIB_EXPORT_GLTF_SCENE_H_

#include <string>

#include "splitfusion/lib/export/export_scene.h"
#include "splitfusion/lib/export/influences.h"

namespace splitfusion {

/// How surfaces move in a glTF file.
struct GltfOptions {
  /// Most nodes that carry a vertex: 4 or 8, in one or two sets.
  int influences = 8;
  /// A shape for every frame (morph targets) instead of nodes that carry it.
  bool bake = false;
  /// Shown in its colours as they are, without light (KHR_materials_unlit).
  bool unlit = true;

  /// @throw OptionError on other `influences`.
  void Check() const;
};

/// Writes a run as animated glTF 2.0, binary. A surface that deforms is a
/// skinned mesh, the nodes of its graph are the joints (Eq. 2 is linear blend
/// skinning); rigid ones are moved as they are; the camera is one of glTF's. A
/// surface that is not there is scaled to zero.
///
/// `scene`: with ExportOptions::y_up. Returns how far the skinning of the file
/// carries vertices from where all nodes would.
///
/// @throw InputError if the file cannot be written or would be too large.
InfluenceError WriteGltf(const std::string& path, const ExportScene& scene,
                         const GltfOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_GLTF_SCENE_H_
