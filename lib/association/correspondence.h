#ifndef SPLITFUSION_LIB_ASSOCIATION_CORRESPONDENCE_H_
#define SPLITFUSION_LIB_ASSOCIATION_CORRESPONDENCE_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "splitfusion/lib/deformation/skinning.h"

namespace splitfusion {

/// A visible point of the model, carried by the graph.
struct ModelSample {
  Eigen::Vector3f point;   ///< Canonical, metres.
  Eigen::Vector3f normal;  ///< Canonical, unit length, outward.
  /// Grey value of the model's colour, 0..1: fine and coarse, see LiveView.
  std::array<float, 2> intensity{};
  int u = 0;          ///< Column of the full image it was rendered at.
  int v = 0;          ///< Row of the full image it was rendered at.
  Skinning skinning;  ///< Nodes that carry it.
};

/// A model point and the live point it should come to lie on.
struct Correspondence {
  /// The model point, canonical, with its skinning.
  ModelSample model;
  Eigen::Vector3f warped_normal;  ///< Model normal under the current warp.
  Eigen::Vector3f target;         ///< Live point, camera frame, metres.
  Eigen::Vector3f target_normal;  ///< Live normal, camera frame.
  /// Confidence, (sigma_0 / sigma(z))^2 with the depth noise sigma; residuals
  /// are multiplied by its root, so that near and far points agree in noise.
  float weight = 1;
  /// Live pixel at which the model point was seen when associated.
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
  /// Live grey value there less that of the model, 0..1, after the common
  /// change of brightness was taken out; 0 if the model's is not known.
  float intensity_difference = 0;
  /// Grey value of the model that it is the difference from, 0..1.
  float model_intensity = 0;
  /// Derivative of the live grey value by column and row, 1 / pixel.
  Eigen::Vector2f intensity_gradient = Eigen::Vector2f::Zero();
};

/// A model point and where it is seen now because it was followed there from
/// image to image, see PointTracks.
struct TrackedPoint {
  /// The model point, canonical, with its skinning.
  ModelSample model;
  /// Live point at the pixel where it is seen, camera frame, metres.
  Eigen::Vector3f target = Eigen::Vector3f::Zero();
  float weight = 1;  ///< Confidence, as Correspondence::weight.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ASSOCIATION_CORRESPONDENCE_H_
