#include "splitfusion/lib/synthetic/solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "splitfusion/lib/base/pi.h"

namespace splitfusion {
namespace {

using Eigen::Vector3f;

Eigen::Matrix3f WorldFromLocal(const Solid& solid) {
  return Eigen::AngleAxisf(solid.yaw, Vector3f::UnitZ()).toRotationMatrix();
}

/// A patch in units of the half sizes; u, v in 0..1; du x dv points outwards.
using Patch = std::function<Vector3f(float u, float v)>;

int CellsAlong(float length, float cell) {
  return std::max(1, static_cast<int>(std::ceil(length / cell - 1e-4f)));
}

class PatchAppender {
 public:
  PatchAppender(const Solid& solid, TexturedMesh* out)
      : solid_(solid), rotation_(WorldFromLocal(solid)), out_(out) {}

  void Append(int cells_u, int cells_v, const Patch& patch) {
    TriangleMesh& mesh = out_->mesh;
    const int first = static_cast<int>(mesh.vertices.size());
    for (int j = 0; j <= cells_v; ++j) {
      for (int i = 0; i <= cells_u; ++i) {
        const Vector3f unit = patch(static_cast<float>(i) / cells_u,
                                    static_cast<float>(j) / cells_v);
        mesh.vertices.push_back(
            solid_.center + rotation_ * unit.cwiseProduct(solid_.half_size));
      }
    }
    for (int j = 0; j < cells_v; ++j) {
      for (int i = 0; i < cells_u; ++i) {
        const int a = first + j * (cells_u + 1) + i;
        const int c = a + cells_u + 1;
        AppendTriangle(a, a + 1, c + 1);
        AppendTriangle(a, c + 1, c);
      }
    }
  }

 private:
  void AppendTriangle(int a, int b, int c) {
    if (solid_.inside_out) std::swap(b, c);
    const auto& v = out_->mesh.vertices;
    // Poles and cap centres give triangles without area.
    if ((v[b] - v[a]).cross(v[c] - v[a]).norm() < 1e-9f) return;
    out_->mesh.triangles.emplace_back(a, b, c);
    out_->triangle_materials.push_back(solid_.material);
    out_->triangle_instances.push_back(solid_.instance);
  }

  const Solid& solid_;
  Eigen::Matrix3f rotation_;
  TexturedMesh* out_;
};

void AppendBox(const Solid& solid, float cell, PatchAppender* appender) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
    const int cells_u = CellsAlong(2 * solid.half_size[u_axis], cell);
    const int cells_v = CellsAlong(2 * solid.half_size[v_axis], cell);
    for (const float side : {-1.0f, 1.0f}) {
      appender->Append(cells_u, cells_v, [&](float u, float v) {
        Vector3f p;
        p[axis] = side;
        p[u_axis] = side * (2 * u - 1);
        p[v_axis] = 2 * v - 1;
        return p;
      });
    }
  }
}

int CellsAround(const Solid& solid, float cell) {
  const float radius = std::max(solid.half_size.x(), solid.half_size.y());
  return std::max(16, CellsAlong(2 * kPi<float> * radius, cell));
}

void AppendCylinder(const Solid& solid, float cell, PatchAppender* appender) {
  const int around = CellsAround(solid, cell);
  const int up = CellsAlong(2 * solid.half_size.z(), cell);
  const int across = CellsAlong(solid.half_size.x(), cell);
  const auto rim = [](float u, float radius, float z) {
    const float angle = 2 * kPi<float> * u;
    return Vector3f(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  appender->Append(around, up,
                   [&](float u, float v) { return rim(u, 1, 2 * v - 1); });
  appender->Append(around, across,
                   [&](float u, float v) { return rim(u, 1 - v, 1); });
  appender->Append(around, across,
                   [&](float u, float v) { return rim(u, v, -1); });
}

void AppendSphere(const Solid& solid, float cell, PatchAppender* appender) {
  const int around = CellsAround(solid, cell);
  const int up =
      std::max(8, CellsAlong(kPi<float> * solid.half_size.z(), cell));
  appender->Append(around, up, [](float u, float v) {
    const float angle = 2 * kPi<float> * u, latitude = kPi<float> * (v - 0.5f);
    return Vector3f(std::cos(latitude) * std::cos(angle),
                    std::cos(latitude) * std::sin(angle), std::sin(latitude));
  });
}

}  // namespace

bool Contains(const Solid& solid, const Vector3f& point) {
  const Vector3f unit =
      (WorldFromLocal(solid).transpose() * (point - solid.center))
          .cwiseQuotient(solid.half_size);
  switch (solid.shape) {
    case SolidShape::kCylinder:
      return std::abs(unit.z()) <= 1 && unit.head<2>().norm() <= 1;
    case SolidShape::kSphere:
      return unit.norm() <= 1;
    case SolidShape::kBox:
      break;
  }
  return unit.cwiseAbs().maxCoeff() <= 1;
}

void AppendSolid(const Solid& solid, float cell, TexturedMesh* out) {
  PatchAppender appender(solid, out);
  switch (solid.shape) {
    case SolidShape::kBox:
      AppendBox(solid, cell, &appender);
      break;
    case SolidShape::kCylinder:
      AppendCylinder(solid, cell, &appender);
      break;
    case SolidShape::kSphere:
      AppendSphere(solid, cell, &appender);
      break;
  }
}

}  // namespace splitfusion
