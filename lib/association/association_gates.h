#ifndef SPLITFUSION_LIB_ASSOCIATION_ASSOCIATION_GATES_H_
#define SPLITFUSION_LIB_ASSOCIATION_ASSOCIATION_GATES_H_

namespace splitfusion {

/// When a model point and a live point are taken for the same.
struct AssociationGates {
  double distance = 0;        ///< Metres; grows with the depth noise.
  double normal_angle = 0;    ///< Radians between the normals; grows likewise.
  double grazing_angle = 0;   ///< Radians between live normal and view ray.
  bool coarse_color = false;  ///< Compare colours at the coarse level.
  double lost_distance = 0;   ///< Of Association::lost, metres; 0: none.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ASSOCIATION_ASSOCIATION_GATES_H_
