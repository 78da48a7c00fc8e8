#ifndef SPLITFUSION_LIB_ASSOCIATION_LOST_PARTS_H_
#define SPLITFUSION_LIB_ASSOCIATION_LOST_PARTS_H_

#include <vector>

#include "splitfusion/lib/association/association.h"

namespace splitfusion {

/// Certain live points of a surface, at every `stride`-th row and column and
/// not seen at grazing angles, beside none of which a correspondence was found.
struct OpenPoints {
  std::vector<Eigen::Vector3f> points;   ///< Camera frame, metres.
  std::vector<Eigen::Vector3f> normals;  ///< Camera frame.
  std::vector<float> weights;            ///< Of their depth, 0..1.
};

/// Finds them.
OpenPoints FindOpenPoints(const LiveView& live, std::uint16_t surface,
                          const std::vector<Correspondence>& found, int stride,
                          const AssociationGates& gates);

/// Pairs every open point with the nearest of `astray` under the warp, model
/// samples that would be in view but are not where the model has them, if it is
/// nearer than gates.lost_distance and its normal passes gates.normal_angle.
/// Colours are not compared.
std::vector<Correspondence> PairLostParts(
    const OpenPoints& open, const std::vector<const ModelSample*>& astray,
    const WarpField& warp, const AssociationGates& gates);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ASSOCIATION_LOST_PARTS_H_
