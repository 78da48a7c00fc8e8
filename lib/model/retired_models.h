#ifndef SPLITFUSION_LIB_MODEL_RETIRED_MODELS_H_
#define SPLITFUSION_LIB_MODEL_RETIRED_MODELS_H_

#include <memory>
#include <utility>

#include "splitfusion/lib/base/spooled_list.h"
#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/motion_log.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// What there is of a surface, or of a part of one, while it is tracked.
struct TrackedModel {
  TriangleMesh mesh;       ///< Canonical frame, metres.
  DeformationGraph graph;  ///< Its motions are the last ones.
  MotionLog history;       ///< Motions of all its frames, one at least.

  /// Saves or restores it, but for the motions in the file of a complete log,
  /// see MotionLog::SerializeIndex().
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(mesh, graph);
    history.SerializeIndex(archive);
  }
};

/// Models of a surface, and parts of them, that are used no more, in the order
/// in which they ended. Nothing asks for them before the end: all of them lies
/// in a temporary file, as there may be thousands in a long recording.
class RetiredModels {
 public:
  /// `file`: where they go.
  explicit RetiredModels(std::shared_ptr<SpoolFile> file)
      : file_(std::move(file)), models_(file_) {}

  /// Their number.
  int size() const { return models_.size(); }

  /// Takes one more; `history` is complete, see MotionLog::Finish().
  ///
  /// @throw InputError if the file cannot be written.
  void Add(TriangleMesh mesh, DeformationGraph graph, MotionLog history);

  /// The model i, 0..size() - 1.
  ///
  /// @throw InputError if the file cannot be read.
  TrackedModel At(int i) const;

  /// Saves or restores them, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive);

 private:
  std::shared_ptr<SpoolFile> file_;
  SpooledList<TrackedModel> models_;  // Their motions are in the file already.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_RETIRED_MODELS_H_
