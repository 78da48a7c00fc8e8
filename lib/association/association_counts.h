#ifndef SPLITFUSION_LIB_ASSOCIATION_ASSOCIATION_COUNTS_H_
#define SPLITFUSION_LIB_ASSOCIATION_ASSOCIATION_COUNTS_H_

namespace splitfusion {

/// What became of the model points of one projective association. Every model
/// point is counted exactly once below `model_points`.
struct AssociationCounts {
  int model_points = 0;  ///< Visible model samples.
  /// Became correspondences.
  int accepted = 0;
  int outside_image = 0;  ///< Projects outside the live image.
  int no_depth = 0;       ///< No live depth or normal at the pixel.
  int occluded = 0;       ///< Behind the live pixel of another surface.
  int other_surface = 0;  ///< Another one's pixel, not nearer; or uncertain.
  int depth_edge = 0;     ///< The live pixel lies on a depth discontinuity.
  int distance = 0;       ///< Farther apart than the gate.
  int normal_angle = 0;   ///< Normals differ by more than the gate.
  int grazing = 0;        ///< Live surface seen at too flat an angle.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ASSOCIATION_ASSOCIATION_COUNTS_H_
