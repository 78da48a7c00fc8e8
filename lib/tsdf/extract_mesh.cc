#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {
namespace {

using Sampler = openvdb::tools::GridSampler<openvdb::FloatGrid::ConstAccessor,
                                            openvdb::tools::BoxSampler>;
using ColorSampler =
    openvdb::tools::GridSampler<openvdb::Vec3SGrid::ConstAccessor,
                                openvdb::tools::BoxSampler>;

/// Attributes of mesh vertices; one object per task, accessors are not shared.
class VertexSampler {
 public:
  VertexSampler(const TsdfVolume& volume, float min_weight)
      : min_weight_(min_weight),
        distance_accessor_(volume.grids().distance->getConstAccessor()),
        weight_accessor_(volume.grids().weight->getConstAccessor()),
        color_accessor_(volume.grids().color->getConstAccessor()),
        distance_(distance_accessor_, volume.grids().distance->transform()),
        color_(color_accessor_, volume.grids().color->transform()) {}

  /// Whether all eight voxels around an index-space point were observed.
  bool Observed(const openvdb::Vec3d& p) const {
    const openvdb::Coord base = openvdb::Coord::floor(p);
    for (int corner = 0; corner < 8; ++corner) {
      const openvdb::Coord at =
          base.offsetBy(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
      if (!(weight_accessor_.getValue(at) >= min_weight_)) return false;
    }
    return true;
  }

  Eigen::Vector3f Normal(const openvdb::Vec3d& p) const {
    Eigen::Vector3f gradient;
    for (int axis = 0; axis < 3; ++axis) {
      openvdb::Vec3d low = p, high = p;
      low[axis] -= 0.75;
      high[axis] += 0.75;
      // At the border of what was observed, not beyond the vertex's own cell.
      if (!Observed(low)) low[axis] = std::floor(p[axis]);
      if (!Observed(high)) high[axis] = std::floor(p[axis]) + 1;
      const double length = high[axis] - low[axis];
      gradient[axis] = static_cast<float>(
          (distance_.isSample(high) - distance_.isSample(low)) / length);
    }
    const float length = gradient.norm();
    return length > 0 ? Eigen::Vector3f(gradient / length)
                      : Eigen::Vector3f(0, 0, 0);
  }

  std::array<std::uint8_t, 3> Color(const openvdb::Vec3d& p) const {
    const openvdb::Vec3s rgb = color_.isSample(p);
    std::array<std::uint8_t, 3> color;
    for (int k = 0; k < 3; ++k) {
      color[k] = static_cast<std::uint8_t>(
          std::clamp(std::lround(rgb[k] * 255), 0l, 255l));
    }
    return color;
  }

 private:
  float min_weight_;
  openvdb::FloatGrid::ConstAccessor distance_accessor_;
  openvdb::FloatGrid::ConstAccessor weight_accessor_;
  openvdb::Vec3SGrid::ConstAccessor color_accessor_;
  Sampler distance_;
  ColorSampler color_;
};

/// New index of every kept vertex, -1 for the others.
std::vector<int> Renumber(const std::vector<char>& keep) {
  std::vector<int> index(keep.size(), -1);
  int next = 0;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (keep[i]) index[i] = next++;
  }
  return index;
}

}  // namespace

TriangleMesh ExtractMesh(const TsdfVolume& volume, double min_weight) {
  openvdb::tools::VolumeToMesh mesher(0.0);
  mesher(*volume.grids().distance);
  const openvdb::math::Transform& transform =
      volume.grids().distance->transform();
  const std::size_t point_count = mesher.pointListSize();
  std::vector<char> keep(point_count);
  TriangleMesh all;
  all.vertices.resize(point_count);
  all.normals.resize(point_count);
  all.colors.resize(point_count);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, point_count, 2048),
      [&](const tbb::blocked_range<std::size_t>& range) {
        const VertexSampler sampler(volume, static_cast<float>(min_weight));
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const openvdb::Vec3s& world = mesher.pointList()[i];
          const openvdb::Vec3d p = transform.worldToIndex(world);
          keep[i] = sampler.Observed(p);
          if (!keep[i]) continue;
          all.vertices[i] = Eigen::Vector3f(world[0], world[1], world[2]);
          all.normals[i] = sampler.Normal(p);
          all.colors[i] = sampler.Color(p);
        }
      });
  const std::vector<int> index = Renumber(keep);
  TriangleMesh mesh;
  for (std::size_t i = 0; i < point_count; ++i) {
    if (!keep[i]) continue;
    mesh.vertices.push_back(all.vertices[i]);
    mesh.normals.push_back(all.normals[i]);
    mesh.colors.push_back(all.colors[i]);
  }
  const auto add = [&](unsigned a, unsigned b, unsigned c) {
    const Eigen::Vector3i triangle(index[a], index[b], index[c]);
    if (triangle.minCoeff() >= 0) mesh.triangles.push_back(triangle);
  };
  for (std::size_t n = 0; n < mesher.polygonPoolListSize(); ++n) {
    const openvdb::tools::PolygonPool& pool = mesher.polygonPoolList()[n];
    for (std::size_t i = 0; i < pool.numQuads(); ++i) {
      const openvdb::Vec4I& quad = pool.quad(i);
      add(quad[0], quad[1], quad[2]);
      add(quad[0], quad[2], quad[3]);
    }
    for (std::size_t i = 0; i < pool.numTriangles(); ++i) {
      const openvdb::Vec3I& triangle = pool.triangle(i);
      add(triangle[0], triangle[1], triangle[2]);
    }
  }
  return mesh;
}

}  // namespace splitfusion
