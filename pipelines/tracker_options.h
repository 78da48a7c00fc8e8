#ifndef SPLITFUSION_PIPELINES_TRACKER_OPTIONS_H_
#define SPLITFUSION_PIPELINES_TRACKER_OPTIONS_H_

#include <string>
#include <vector>

#include "splitfusion/lib/association/association_gates.h"
#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/pipelines/part_start_options.h"

namespace splitfusion {

/// Rounds (association + minimisation) at one image resolution.
struct TrackingStage {
  int stride = 1;  ///< Every stride-th pixel.
  int rounds = 1;  ///< At most; ends earlier when the cost settles.
  /// Rejection of correspondences.
  AssociationGates gates;
};

/// How one surface is tracked in one frame.
struct TrackerOptions {
  std::string association = "projective";  ///< A name of the registry in use.
  double rigid_distance = 0.10;  ///< First gate of the rigid stages, metres.
  double rigid_angle = 30;       ///< First one of normals, degrees.
  double non_rigid_distance = 0.10;  ///< First gate of the non-rigid stages.
  double non_rigid_angle = 45;       ///< Of normals, degrees.
  /// Of Association::lost in the first non-rigid stage, metres. In the second
  /// one the correspondences have the last word.
  double lost_distance = 0.25;
  double grazing_angle = 75;  ///< Between live normal and view ray, degrees.
  /// EnergyInput::anneal falls from this to 1 over the non-rigid rounds.
  double prior_anneal = 8;
  /// A stage ends when the cost changes by less than this fraction.
  double settled = 2e-3;
  /// Lost below as many correspondences in the last round ...
  int min_correspondences = 60;
  /// ... or below this fraction of the samples that meet live depth of the
  /// surface ...
  double min_accepted = 0.25;
  /// ... or if after all stages less than this fraction of what should be in
  /// view of it, apart from what no depth tells of, lies on it. Of deforming
  /// surfaces, but for the background, before which undetected things may
  /// stand ...
  double min_fit = 0.45;
  /// ... or if the rigid stages moved it by more than this.
  double max_translation = 0.35;  ///< Metres.
  double max_rotation = 35;       ///< Degrees.
  /// The constant-velocity prediction is believed if its misfit is below this
  /// fraction of that of standing still.
  double velocity_gain = 0.85;
  /// A surface with fewer samples than this at a stage's stride is tracked at
  /// half of it, down to the model map's own.
  int min_samples = 1500;
  /// The trust region of a round starts from that of the round before.
  bool keep_radius = true;
  /// Where parts of a deforming surface start.
  PartStartOptions part_start;

  /// The stages in which all nodes share one motion, coarse to fine.
  std::vector<TrackingStage> RigidStages() const;
  /// The stages in which every node moves.
  std::vector<TrackingStage> NonRigidStages() const;

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
  /// @throw OptionError if a value is out of its range.
  void Check() const;

 private:
  /// Those beyond which a surface is lost.
  void ListBounds(OptionList* list);
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_TRACKER_OPTIONS_H_
