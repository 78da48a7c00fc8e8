#ifndef SPLITFUSION_TOOLS_BENCHMARK_FUSION_SCENES_H_
#define SPLITFUSION_TOOLS_BENCHMARK_FUSION_SCENES_H_

#include <tbb/global_control.h>

#include <memory>
#include <utility>
#include <vector>

#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"
#include "splitfusion/lib/tsdf/warped_integration.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {

/// As many threads as the figures are stated for, while it lives.
struct TwoThreads {
  /// Holds TBB to two threads.
  tbb::global_control control{tbb::global_control::max_allowed_parallelism, 2};
};

/// A volume of the synthetic room: some frames fused under their exact poses.
struct RoomModel {
  /// Blocks of one more frame are allocated.
  explicit RoomModel(const TsdfOptions& options);

  TsdfVolume volume;              ///< Canonical frame: the world.
  DepthObservation observation;   ///< Of the next frame.
  Rigid3d camera_from_canonical;  ///< Of that frame.
};

/// The room in 5 mm voxels with a truncation of 4, made when first asked for.
RoomModel& FineRoom(bool has_color);

/// A standing person about 2 m from a standing camera, modelled with about 400
/// nodes and 5 mm voxels; frames differ in their noise.
struct PersonModel {
  PersonModel();

  /// The one that all rows share, made when first asked for.
  static PersonModel& Shared();

  SyntheticScene scene;
  std::vector<DepthObservation> observations;  ///< Of two more frames.
  TsdfVolume volume;                           ///< Frames fused so far.
  DeformationGraph graph;                ///< Camera frame = canonical frame.
  std::unique_ptr<SkinningIndex> index;  ///< Of the graph.
  WarpedIntegrator integrator;           ///< Of the graph.
  double reach = 0.35;                   ///< Of its nodes, metres.

  /// Fuses one of the observations.
  void Integrate(int observation);
};

/// A frame with its masks.
struct MaskedFrame {
  Frame frame;                      ///< Its index is its place in the film.
  std::vector<InstanceMask> masks;  ///< Of that frame.
};

/// The first frames of a scene with the masks that its detector gives.
std::vector<MaskedFrame> FilmScene(const SyntheticScene& scene, int count);

/// Hands out the masks of a film.
class GivenMasks : public Segmenter {
 public:
  /// Only of these frames.
  explicit GivenMasks(std::vector<MaskedFrame> film) : film_(std::move(film)) {}

  /// The masks that the frame has by its index.
  std::vector<InstanceMask> Segment(const Frame& frame) override {
    return film_.at(frame.index).masks;
  }

 private:
  const std::vector<MaskedFrame> film_;
};

/// Room, walking person and toy after some frames of the whole method with its
/// default options and exact masks; and the last frame.
struct TrackedScene {
  TrackedScene();

  /// The one that all rows share, made when first asked for.
  static const TrackedScene& Shared();

  SyntheticScene scene;
  std::vector<MaskedFrame> film;  ///< All frames so far.
  SplitFusion fusion;
  LiveView live;  ///< The last frame.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_FUSION_SCENES_H_
