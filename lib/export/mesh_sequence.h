#ifndef SPLITFUSION_LIB_EXPORT_MESH_SEQUENCE_H_
#define SPLITFUSION_LIB_EXPORT_MESH_SEQUENCE_H_

#include <string>

#include "splitfusion/lib/export/export_scene.h"

namespace splitfusion {

/// What the files of a sequence are.
enum class MeshFileKind {
  kPly,  ///< Binary, as the run's.
  kObj,  ///< WriteObj()
  kPcd,  ///< WritePcd()
};

/// Writes every surface in every frame in which it is there as
/// `FOLDER/SURFACE/FRAME.ply` (or .obj, .pcd); surfaces that stand still once,
/// as of the first frame. Returns the number of files.
///
/// `grow`: triangles of what had been seen by the frame alone, as warped/ has
/// them; else the same in all. `folder` must be there.
/// @throw InputError if a file cannot be written.
int WriteMeshSequence(const std::string& folder, const ExportScene& scene,
                      MeshFileKind kind, bool grow);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_MESH_SEQUENCE_H_
