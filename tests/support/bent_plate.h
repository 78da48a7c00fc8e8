#ifndef SPLITFUSION_TESTS_SUPPORT_BENT_PLATE_H_
#define SPLITFUSION_TESTS_SUPPORT_BENT_PLATE_H_

#include <Eigen/Core>
#include <string>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// A plate that is rolled up more and more about a vertical axis in front of a
/// wall, seen by a moving camera: everything is known in closed form. Written
/// as a run directory it is a perfect run.
///
/// World of the run = first camera. The plate is 0.4 x 0.3 m at z = 1 m, flat
/// in frame 0; the wall is 2 x 2 m at z = 1.5 m.
struct BentPlate {
  int frames = 12;              ///< Frames of the sequence.
  double curvature_step = 0.3;  ///< Added every frame, 1 / m.
  int first_frame = 0;          ///< Of the plate's motions in the run.

  /// Intrinsics of the live camera.
  static PinholeCamera Camera();
  /// Time stamp of a frame, seconds.
  static double Timestamp(int frame);
  /// Stem of the depth file of a frame.
  static std::string Stem(int frame);

  /// World of the ground truth from world of the run.
  static Rigid3d TrueWorldFromWorld();
  /// Camera pose in the world of the run.
  Rigid3d WorldFromCamera(int frame) const;

  /// Where the point of the plate that is (x, y, 1) in frame 0 is in a frame;
  /// world of the run, metres.
  Eigen::Vector3d PointAt(double x, double y, int frame) const;
  /// The plate in a frame, world of the run; vertices every 1 cm.
  TriangleMesh PlateAt(int frame) const;
  /// The wall, world of the run.
  static TriangleMesh Wall();

  /// Writes the run directory (no masks).
  void WriteRun(const std::string& folder) const;
  /// Writes groundtruth.txt, labels.json, static_mesh.ply, mesh/ (frames 0 and
  /// 6), label/ (the same) and tracks.bin (a grid of 5 x 5 points, visible in
  /// all frames).
  void WriteGroundTruth(const std::string& folder) const;
  /// Writes what the camera sees as a sequence in TUM layout (depth without
  /// noise, colour black), and into the run directory its masks and an
  /// options.flags that names it.
  void WriteSequence(const std::string& folder, const std::string& run) const;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_BENT_PLATE_H_
