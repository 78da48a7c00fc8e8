#include "splitfusion/lib/evaluation/surface_error.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <random>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/geometry/triangle_tree.h"

namespace splitfusion {
namespace {

constexpr unsigned kAccuracySeed = 1;
constexpr unsigned kCompletenessSeed = 2;

std::vector<Eigen::Vector3f> SampleVertices(
    const std::vector<Eigen::Vector3f>& vertices, int count,
    std::mt19937* random) {
  std::vector<Eigen::Vector3f> points = vertices;
  std::shuffle(points.begin(), points.end(), *random);
  if (static_cast<int>(points.size()) > count) points.resize(count);
  return points;
}

/// Running sum of the areas of the triangles, square metres, each times its
/// weight if there are weights.
std::vector<double> CumulativeAreas(const TriangleMesh& mesh,
                                    const std::vector<double>& weights) {
  std::vector<double> sums;
  sums.reserve(mesh.triangles.size());
  double sum = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d ab = mesh.vertices[t[1]].cast<double>() - a;
    const Eigen::Vector3d ac = mesh.vertices[t[2]].cast<double>() - a;
    const double weight = weights.empty() ? 1 : weights[sums.size()];
    sum += 0.5 * ab.cross(ac).norm() * weight;
    sums.push_back(sum);
  }
  return sums;
}

Eigen::Vector3f PointOfTriangle(const TriangleMesh& mesh,
                                const Eigen::Vector3i& t, double u, double v) {
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const Eigen::Vector3f& a = mesh.vertices[t[0]];
  return a + static_cast<float>(u) * (mesh.vertices[t[1]] - a) +
         static_cast<float>(v) * (mesh.vertices[t[2]] - a);
}

/// The triangles (vertices, of a cloud) all of whose corners pass `keep`.
template <typename Predicate>
TriangleMesh Filtered(const TriangleMesh& mesh, const Predicate& keep) {
  TriangleMesh result;
  if (mesh.triangles.empty()) {
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      if (keep(i)) result.vertices.push_back(mesh.vertices[i]);
    }
    return result;
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    if (keep(t[0]) && keep(t[1]) && keep(t[2])) result.triangles.push_back(t);
  }
  // Without a triangle nothing is left; vertices alone would be a cloud.
  if (!result.triangles.empty()) result.vertices = mesh.vertices;
  return result;
}

/// Triangles for a search; the vertices of a cloud are degenerate ones.
std::vector<Eigen::Vector3i> SearchTriangles(const TriangleMesh& mesh) {
  if (!mesh.triangles.empty()) return mesh.triangles;
  std::vector<Eigen::Vector3i> points;
  for (int i = 0; i < static_cast<int>(mesh.vertices.size()); ++i) {
    points.emplace_back(i, i, i);
  }
  return points;
}

}  // namespace

void SurfaceErrorOptions::Check() const {
  CheckOption(samples >= 1 && samples <= 10000000, "samples", samples,
              "1..10000000");
  CheckOption(max_distance > 0, "max_distance", max_distance, "metres > 0");
  CheckOption(min_seen >= 0, "min_seen", min_seen, ">= 0");
}

TrueSurface ReadTrueSurface(const std::string& path) {
  TrueSurface surface;
  PlyProperties properties;
  surface.mesh = ReadPly(path, &properties);
  if (surface.mesh.empty()) {
    throw InputError(path + ": 0 vertices: expected a surface");
  }
  surface.seen = std::move(properties["seen"]);
  surface.label = std::move(properties["label"]);
  return surface;
}

std::vector<Eigen::Vector3f> SampleSurface(const TriangleMesh& mesh, int count,
                                           unsigned seed,
                                           const std::vector<double>& weights) {
  std::mt19937 random(seed);
  if (mesh.triangles.empty()) {
    return SampleVertices(mesh.vertices, count, &random);
  }
  const std::vector<double> areas = CumulativeAreas(mesh, weights);
  std::vector<Eigen::Vector3f> points;
  if (!(areas.back() > 0)) return points;
  points.reserve(count);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < count; ++i) {
    const auto found = std::lower_bound(areas.begin(), areas.end(),
                                        uniform(random) * areas.back());
    const std::size_t t =
        std::min<std::size_t>(found - areas.begin(), areas.size() - 1);
    const double u = uniform(random);
    const double v = uniform(random);
    points.push_back(PointOfTriangle(mesh, mesh.triangles[t], u, v));
  }
  return points;
}

double HarmonicMean(double a, double b) {
  return a + b > 0 ? 2 * a * b / (a + b) : 0;
}

std::vector<double> DistancesToSurface(
    const std::vector<Eigen::Vector3f>& points, const TriangleMesh& surface,
    double max_distance) {
  const TriangleTree tree(surface.vertices, SearchTriangles(surface));
  std::vector<double> distances(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    const SurfacePoint nearest =
        tree.Closest(points[i], static_cast<float>(max_distance));
    distances[i] = nearest.triangle < 0 ? max_distance : nearest.distance;
  });
  return distances;
}

SurfaceDistances DescribeDistances(const std::vector<double>& distances) {
  SurfaceDistances result;
  result.statistics = Summarize(distances);
  for (std::size_t i = 0; i < kSurfaceThresholds.size(); ++i) {
    result.within[i] = FractionWithin(distances, kSurfaceThresholds[i]);
  }
  return result;
}

SurfaceError CompareSurfaces(const TriangleMesh& reconstructed,
                             const TrueSurface& truth,
                             const SurfaceErrorOptions& options) {
  options.Check();
  const TriangleMesh labelled = Filtered(truth.mesh, [&](std::size_t v) {
    return !options.label || truth.label.empty() ||
           static_cast<int>(truth.label[v]) == *options.label;
  });
  const TriangleMesh visible = Filtered(truth.mesh, [&](std::size_t v) {
    return (!options.label || truth.label.empty() ||
            static_cast<int>(truth.label[v]) == *options.label) &&
           (truth.seen.empty() || truth.seen[v] >= options.min_seen);
  });
  SurfaceError error;
  error.accuracy = DescribeDistances(DistancesToSurface(
      SampleSurface(reconstructed, options.samples, kAccuracySeed), labelled,
      options.max_distance));
  error.completeness = DescribeDistances(DistancesToSurface(
      SampleSurface(visible, options.samples, kCompletenessSeed), reconstructed,
      options.max_distance));
  for (std::size_t i = 0; i < kSurfaceThresholds.size(); ++i) {
    error.f_score[i] =
        HarmonicMean(error.accuracy.within[i], error.completeness.within[i]);
  }
  return error;
}

}  // namespace splitfusion
