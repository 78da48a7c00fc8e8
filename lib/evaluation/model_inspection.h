#ifndef SPLITFUSION_LIB_EVALUATION_MODEL_INSPECTION_H_
#define SPLITFUSION_LIB_EVALUATION_MODEL_INSPECTION_H_

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/evaluation/live_images.h"
#include "splitfusion/lib/evaluation/presence.h"
#include "splitfusion/lib/evaluation/recorded_run.h"

namespace splitfusion {

/// A share of area over the frames.
struct ShareOverFrames {
  double mean = 0;       ///< Over the frames.
  double worst = 0;      ///< Largest.
  int worst_frame = -1;  ///< Where that is; the first of several.
};

/// The shape of one surface in the frames of a run.
struct SurfaceShape {
  int surface_id = 0;           ///< 0 is the background.
  std::string surface_label;    ///< Its label.
  int frames = 0;               ///< Frames looked at that have a model.
  ShareOverFrames stretched;    ///< StretchedArea::Share().
  int stretched_triangles = 0;  ///< Of the worst frame.
  double longest_edge = 0;      ///< Of all frames, metres.
  std::optional<ShareOverFrames> stray;  ///< StrayArea::Share(), live depth
                                         ///< provided.
};

/// What the models of all frames look like beside the live images.
struct ModelInspection {
  std::vector<SurfaceShape> shapes;  ///< By id; without the background.
  /// Instance -> its sightings; empty without live images or label images.
  std::map<int, std::vector<InstanceSighting>> sightings;
};

/// Which true instances are looked for in which label images.
struct InstanceLabels {
  std::string folder;       ///< label/ of the ground truth; empty = nothing.
  std::set<int> instances;  ///< Instance ids.
};

/// Looks at the models of every `every`-th frame: all surfaces but the
/// background that have motions there, tracked or not. Frames are looked at in
/// parallel.
///
/// `live`: null if the sequence is not at hand. A surface shows a pixel as by
/// ShownPixels().
/// @throw InputError if an image is missing or broken.
ModelInspection InspectModels(const RecordedRun& run,
                              const std::vector<AnimatedSurface>& surfaces,
                              const LiveImages* live,
                              const InstanceLabels& labels, int every);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_MODEL_INSPECTION_H_
