#ifndef SPLITFUSION_TOOLS_BENCHMARK_GROWTH_SPLIT_MODELS_H_
#define SPLITFUSION_TOOLS_BENCHMARK_GROWTH_SPLIT_MODELS_H_

#include <memory>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/model/surface.h"

namespace splitfusion {

/// Two frames of a room with two people, a step apart, and the pairs of points
/// between them.
struct FramePair {
  /// Images of `height` pixels, 4:3.
  explicit FramePair(int height);

  LiveView before;  ///< What the models are made of.
  LiveView after;   ///< What they are tracked to.
  /// By label, the room first; associated where nothing has moved.
  std::vector<std::vector<Correspondence>> pairs;
};

/// A surface of a model, with its pairs of points.
struct PairedSurface {
  std::unique_ptr<Surface> surface;   ///< Of the frame before.
  std::vector<Correspondence> pairs;  ///< Skinned by its graph.
};

/// All surfaces of a model of the scene.
struct SceneModel {
  std::vector<PairedSurface> surfaces;  ///< The room first.
  LiveView after;                       ///< The frame, labelled by surface.
};

/// A rigid room and one deformation graph a person.
SceneModel MakeSplitModel(const FramePair& frames,
                          const SurfaceOptions& background,
                          const SurfaceOptions& object,
                          const GraphOptions& graph);

/// One deformation graph over everything, for the same pairs.
SceneModel MakeOneGraphModel(const FramePair& frames,
                             const SurfaceOptions& options,
                             const GraphOptions& graph);

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_GROWTH_SPLIT_MODELS_H_
