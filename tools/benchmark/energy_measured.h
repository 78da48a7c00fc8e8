#ifndef SPLITFUSION_TOOLS_BENCHMARK_ENERGY_MEASURED_H_
#define SPLITFUSION_TOOLS_BENCHMARK_ENERGY_MEASURED_H_

#include <string>

#include "energy_floor.h"
#include "energy_reference.h"
#include "energy_scene.h"

namespace splitfusion {

/// The scene, the system of its measured iteration by the library, and the
/// floor from the same Jacobians by plain autodiff; checks that they agree.
class MeasuredEnergy {
 public:
  /// Solves both ways.
  MeasuredEnergy();

  /// The scene.
  const EnergyScene& scene() const { return scene_; }
  /// The floor with the iteration's Jacobians.
  const EnergyFloor& floor() const { return floor_; }

  /// Empty if blocks and gradient of the floor are the library's to 1e-6, the
  /// step with block Jacobi as well in the same number of iterations, and one
  /// plain Ceres problem comes to the same cost; else what is not.
  const std::string& disagreement() const { return disagreement_; }

  /// Does the barest iteration; returns the products of its solver.
  int RunFloor(EnergyFloor* floor) const;

 private:
  std::string Disagreement();

  EnergyScene scene_;
  MeasuredSystem system_;
  EnergyFloor floor_;
  std::string disagreement_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_ENERGY_MEASURED_H_
