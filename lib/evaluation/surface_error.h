#ifndef SPLITFUSION_LIB_EVALUATION_SURFACE_ERROR_H_
#define SPLITFUSION_LIB_EVALUATION_SURFACE_ERROR_H_

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/evaluation/error_statistics.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Distances at which a surface counts as right, metres.
constexpr std::array<double, 3> kSurfaceThresholds = {0.01, 0.02, 0.05};

/// A true surface; `seen` and `label` are empty or have one entry a vertex.
struct TrueSurface {
  TriangleMesh mesh;          ///< World frame, metres.
  std::vector<double> seen;   ///< In how many frames the vertex is visible.
  std::vector<double> label;  ///< Instance, 0 = background.
};

/// Reads a true surface with the vertex properties `seen` and `label`.
///
/// @throw InputError as ReadPly, or if there is no vertex.
TrueSurface ReadTrueSurface(const std::string& path);

/// How a reconstructed surface is compared with the true one.
struct SurfaceErrorOptions {
  int samples = 100000;       ///< Random points, each direction.
  double max_distance = 0.3;  ///< Distances are clipped to this, metres.
  double min_seen = 3;        ///< Completeness: triangles seen in as many.
  std::optional<int> label;   ///< Only triangles of this label; empty = all.

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// Distances from random points of one surface to the other.
struct SurfaceDistances {
  ErrorStatistics statistics;  ///< Metres; clipped.
  /// Fraction within each of kSurfaceThresholds.
  std::array<double, kSurfaceThresholds.size()> within{};
};

/// Result of CompareSurfaces.
struct SurfaceError {
  SurfaceDistances accuracy;      ///< From the reconstruction to the truth.
  SurfaceDistances completeness;  ///< From the truth to the reconstruction.
  /// Harmonic mean of the two fractions within each of kSurfaceThresholds.
  std::array<double, kSurfaceThresholds.size()> f_score{};
};

/// `count` random points, uniform over the area of the triangles of `mesh`; of
/// a mesh without triangles, that many of its vertices. Repeatable by `seed`.
/// `weights`: empty, or a factor on the area of every triangle; no point if all
/// are 0.
std::vector<Eigen::Vector3f> SampleSurface(
    const TriangleMesh& mesh, int count, unsigned seed,
    const std::vector<double>& weights = {});

/// Harmonic mean of two fractions; 0 if both are.
double HarmonicMean(double a, double b);

/// Distances from points to a surface (exact, point to triangle; to vertices
/// if it has no triangles), clipped to `max_distance`; metres.
std::vector<double> DistancesToSurface(
    const std::vector<Eigen::Vector3f>& points, const TriangleMesh& surface,
    double max_distance);

/// Statistics of distances (metres).
SurfaceDistances DescribeDistances(const std::vector<double>& distances);

/// Accuracy, completeness and F-score of a surface in the frame of the truth.
/// `label` restricts the truth, `min_seen` the part of it that has to be
/// covered; both only where the truth has the property.
SurfaceError CompareSurfaces(const TriangleMesh& reconstructed,
                             const TrueSurface& truth,
                             const SurfaceErrorOptions& options = {});

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_SURFACE_ERROR_H_
