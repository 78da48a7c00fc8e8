#include "splitfusion/lib/synthetic/implicit_mesher.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace splitfusion {
namespace {

using Eigen::Vector3f;
using DenseGrid = openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ>;

/// Polynomial smooth minimum: equals min(a, b) where they differ by more than
/// `blend`.
float SmoothMin(float a, float b, float blend) {
  const float h = std::max(blend - std::abs(a - b), 0.0f) / blend;
  return std::min(a, b) - 0.25f * h * h * blend;
}

float UnionDistance(const std::vector<RoundCone>& cones, float blend,
                    const Vector3f& point) {
  float distance = 1e3f;
  for (const RoundCone& cone : cones) {
    distance = SmoothMin(distance, SignedDistance(cone, point), blend);
  }
  return distance;
}

Vector3f UnionGradient(const std::vector<RoundCone>& cones, float blend,
                       const Vector3f& point) {
  constexpr float kStep = 1e-3f;
  Vector3f gradient;
  for (int k = 0; k < 3; ++k) {
    const Vector3f offset = kStep * Vector3f::Unit(k);
    gradient[k] = (UnionDistance(cones, blend, point + offset) -
                   UnionDistance(cones, blend, point - offset)) /
                  (2 * kStep);
  }
  return gradient;
}

openvdb::CoordBBox GridBounds(const std::vector<RoundCone>& cones,
                              float voxel) {
  Vector3f low = Vector3f::Constant(std::numeric_limits<float>::max());
  Vector3f high = -low;
  for (const RoundCone& cone : cones) {
    const auto radius = Vector3f::Constant(
        std::max(cone.start_radius, cone.end_radius) + 4 * voxel);
    low = low.cwiseMin(cone.start.cwiseMin(cone.end) - radius);
    high = high.cwiseMax(cone.start.cwiseMax(cone.end) + radius);
  }
  const Eigen::Vector3i a = (low / voxel).array().floor().cast<int>();
  const Eigen::Vector3i b = (high / voxel).array().ceil().cast<int>();
  return {openvdb::Coord(a.x(), a.y(), a.z()),
          openvdb::Coord(b.x(), b.y(), b.z())};
}

openvdb::FloatGrid::Ptr SampleUnion(const std::vector<RoundCone>& cones,
                                    float blend, float voxel) {
  DenseGrid dense(GridBounds(cones, voxel));
  const openvdb::CoordBBox box = dense.bbox();
  tbb::parallel_for(box.min().z(), box.max().z() + 1, [&](int z) {
    for (int y = box.min().y(); y <= box.max().y(); ++y) {
      for (int x = box.min().x(); x <= box.max().x(); ++x) {
        const Vector3f p = voxel * Vector3f(x, y, z);
        dense.setValue(openvdb::Coord(x, y, z), UnionDistance(cones, blend, p));
      }
    }
  });
  auto grid = openvdb::FloatGrid::create(1e3f);
  openvdb::tools::copyFromDense(dense, *grid, 0.0f);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
  return grid;
}

double SignedVolume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    volume +=
        mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  }
  return volume / 6;
}

}  // namespace

float SignedDistance(const RoundCone& cone, const Vector3f& point) {
  const Vector3f axis = cone.end - cone.start;
  const float length2 = axis.squaredNorm();
  const float t =
      length2 > 0
          ? std::clamp((point - cone.start).dot(axis) / length2, 0.0f, 1.0f)
          : 0.0f;
  return (point - cone.start - t * axis).norm() - cone.start_radius -
         t * (cone.end_radius - cone.start_radius);
}

int NearestBone(const std::vector<RoundCone>& cones, const Vector3f& point) {
  const auto nearest = std::min_element(
      cones.begin(), cones.end(), [&](const RoundCone& a, const RoundCone& b) {
        return SignedDistance(a, point) < SignedDistance(b, point);
      });
  return nearest->bone;
}

TriangleMesh MeshRoundCones(const std::vector<RoundCone>& cones, float blend,
                            float voxel) {
  openvdb::initialize();
  const auto grid = SampleUnion(cones, blend, voxel);
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*grid, points, quads);
  TriangleMesh mesh;
  mesh.vertices.resize(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    Vector3f p(points[i].x(), points[i].y(), points[i].z());
    for (int iteration = 0; iteration < 2; ++iteration) {
      const Vector3f gradient = UnionGradient(cones, blend, p);
      p -= UnionDistance(cones, blend, p) / gradient.squaredNorm() * gradient;
    }
    mesh.vertices[i] = p;
  });
  for (const openvdb::Vec4I& q : quads) {
    mesh.triangles.emplace_back(q[0], q[1], q[2]);
    mesh.triangles.emplace_back(q[0], q[2], q[3]);
  }
  if (SignedVolume(mesh) < 0) {
    for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  mesh.normals = ComputeVertexNormals(mesh);
  return mesh;
}

}  // namespace splitfusion
