#ifndef SPLITFUSION_LIB_ASSOCIATION_POINTWISE_ASSOCIATION_H_
#define SPLITFUSION_LIB_ASSOCIATION_POINTWISE_ASSOCIATION_H_

#include <vector>

#include "splitfusion/lib/association/association.h"
#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {

/// An association that looks for the live pixel of every sample on its own, and
/// then tests the pair: a derived class says which pixel.
class PointwiseAssociator : public Associator {
 public:
  Association Associate(const std::vector<ModelSample>& samples,
                        const WarpField& warp, int stride,
                        const AssociationGates& gates) const override;

 protected:
  /// What became of a sample; the order is that of the tests and of reports.
  enum Outcome {
    kAccepted,      ///< Becomes a correspondence.
    kOutsideImage,  ///< Projects outside the live image.
    kNoDepth,       ///< There is no live depth or normal.
    kOccluded,      ///< Behind the live pixel of another surface.
    kOtherSurface,  ///< Another one's pixel, not nearer; or uncertain.
    kDepthEdge,     ///< The live pixel lies on a depth discontinuity.
    kDistance,      ///< Farther apart than the gate.
    kNormalAngle,   ///< Normals differ by more than the gate.
    kGrazing,       ///< Live surface seen at too flat an angle.
  };

  /// The live pixel of a sample.
  struct LivePixel {
    int u = 0;              ///< Column.
    int v = 0;              ///< Row.
    Eigen::Vector2f place;  ///< Between the pixels, where colour is compared.
  };

  /// `surface`: whose live pixels count; `outcomes`: the rejections of Find().
  /// If it does not tell what is hidden, kOccluded, nothing is known to be
  /// astray, and Association::lost is empty.
  PointwiseAssociator(const LiveView& live, std::uint16_t surface,
                      std::vector<Outcome> outcomes);

  /// Sets the pixel of a sample whose warped point is `point` (camera frame,
  /// metres), unless it says why there is none. A pixel has depth and normal.
  virtual Outcome Find(const Eigen::Vector3f& point,
                       LivePixel* pixel) const = 0;

  const LiveView& live_;         ///< The live frame.
  const std::uint16_t surface_;  ///< Id of the surface.

 private:
  struct Gates;

  Outcome Match(const ModelSample& sample, const WarpField& warp,
                const Gates& gates, Correspondence* out) const;
  /// Whether the angle between the normals is no larger than the gate, and than
  /// noise has it beside.
  bool HaveOneNormal(const Correspondence& pair, const Gates& gates) const;
  static RejectedPoints Row(Outcome outcome);
  /// Whether the sample would be in view and is not where the model has it.
  bool IsAstray(Outcome outcome) const;

  std::vector<Outcome> outcomes_;
  bool tells_hidden_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ASSOCIATION_POINTWISE_ASSOCIATION_H_
