#ifndef SPLITFUSION_LIB_ENERGY_TERM_CONTEXT_H_
#define SPLITFUSION_LIB_ENERGY_TERM_CONTEXT_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/segmentation/label_table.h"
#include "splitfusion/lib/sequence/trajectory.h"

namespace splitfusion {

class SurfaceHistory;
class TermStates;
class TsdfVolume;
struct DeformationGraph;
struct InstanceMask;
struct ModelSample;
struct Skinning;
struct TriangleMesh;

/// The frame in which a surface is tracked.
struct FrameFacts {
  int index = 0;         ///< In the sequence.
  double timestamp = 0;  ///< Seconds.
  /// What was detected in it; null: nothing was looked for.
  const std::vector<InstanceMask>* detections = nullptr;
  /// Poses of the camera in all frames before; null: not known.
  const Trajectory* cameras = nullptr;
};

/// The surface that is tracked, with the whole of its model: what is hidden or
/// has no partner, too. All canonical, metres.
struct SurfaceFacts {
  std::string class_name;                  ///< As "person" or "background".
  SurfaceKind kind = SurfaceKind::kRigid;  ///< Whether it deforms.
  int first_frame = 0;                     ///< Index, of its first observation.
  /// Its mesh with normals and colours; empty of a background that is ray cast.
  const TriangleMesh* mesh = nullptr;
  /// Of every vertex, the nodes of the surface's graph that carry it. In rigid
  /// rounds EnergyInput::graph is another one.
  const std::vector<Skinning>* skinning = nullptr;
  const TsdfVolume* volume = nullptr;  ///< For SampleDistance().
};

/// The model as it was rendered where it is predicted, for every n-th pixel of
/// the live image; what is null was not rendered. A background that is ray cast
/// is alone in its images, in which it has points, normals and colour; other
/// surfaces are in theirs together, with depth and normals.
struct RenderedModel {
  PinholeCamera camera;                          ///< Of these images.
  const cv::Mat_<float>* depth = nullptr;        ///< Metres; 0 = nothing.
  const cv::Mat_<cv::Vec3f>* points = nullptr;   ///< Camera frame; z 0 = none.
  const cv::Mat_<cv::Vec3f>* normals = nullptr;  ///< Camera frame; 0 = none.
  const cv::Mat_<cv::Vec3b>* color = nullptr;    ///< BGR.
};

/// How far tracking is in a frame: first come rigid rounds, then, of a surface
/// that deforms, rounds in which all nodes move.
struct RoundFacts {
  bool rigid = true;  ///< One node carries the whole surface.
  int stage = 0;      ///< From 0 in each of the two, coarse to fine.
  int stride = 1;     ///< Model points of every n-th pixel.
  int round = 0;      ///< From 0 in each of the two.
  int rounds = 1;     ///< Of these, at most: a stage ends when it has settled.
};

/// What goes with the problem of a surface where it is tracked; null, but for
/// the round, what is not known there. It holds during the call alone.
struct TermContext {
  /// The frame.
  const FrameFacts* frame = nullptr;
  /// The surface and its model.
  const SurfaceFacts* surface = nullptr;
  /// Where it was before; null if it was not, or if it is looked for elsewhere.
  const SurfaceHistory* history = nullptr;
  /// The graph of the surface itself; in rigid rounds EnergyInput::graph is
  /// another one, and this is where they start.
  const DeformationGraph* surface_graph = nullptr;
  /// The model in the live view.
  const RenderedModel* rendered = nullptr;
  /// All model points in view, those without a partner, too: at every pixel,
  /// of which associations take those of the round's stride. Carried by the
  /// nodes of EnergyInput::graph.
  const std::vector<ModelSample>* samples = nullptr;
  /// What terms keep of the surface, see EnergyTerm::NewState().
  const TermStates* states = nullptr;
  RoundFacts round;  ///< How far tracking is.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TERM_CONTEXT_H_
