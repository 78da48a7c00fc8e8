#include "support/sample_meshes.h"

#include <cmath>

namespace splitfusion {

TriangleMesh SheetMesh(
    double width, double height, double step,
    const std::function<Eigen::Vector3d(double x, double y)>& place) {
  const int columns = static_cast<int>(std::lround(width / step)) + 1;
  const int rows = static_cast<int>(std::lround(height / step)) + 1;
  TriangleMesh mesh;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      mesh.vertices.push_back(place(column * step, row * step).cast<float>());
    }
  }
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const int a = row * columns + column;
      mesh.triangles.emplace_back(a, a + columns, a + 1);
      mesh.triangles.emplace_back(a + 1, a + columns, a + columns + 1);
    }
  }
  mesh.normals = ComputeVertexNormals(mesh);
  mesh.colors.assign(mesh.vertices.size(), {200, 100, 50});
  return mesh;
}

TriangleMesh PlateMesh(double width, double height, double step, double z) {
  return SheetMesh(width, height, step, [z](double x, double y) {
    return Eigen::Vector3d(x, y, z);
  });
}

TriangleMesh HairpinMesh(double length, double height, double gap,
                         double step) {
  const double radius = gap / 2;
  const double bend = M_PI * radius;
  const auto place = [=](double s, double y) -> Eigen::Vector3d {
    if (s < length) return {s, y, 1};
    if (s > length + bend) return {2 * length + bend - s, y, 1 + gap};
    const double angle = (s - length) / radius;
    return {length + radius * std::sin(angle), y,
            1 + radius * (1 - std::cos(angle))};
  };
  return SheetMesh(2 * length + bend, height, step, place);
}

void AppendMesh(const TriangleMesh& more, TriangleMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.size());
  const auto append = [](const auto& from, auto* to) {
    to->insert(to->end(), from.begin(), from.end());
  };
  append(more.vertices, &mesh->vertices);
  append(more.normals, &mesh->normals);
  append(more.colors, &mesh->colors);
  for (const Eigen::Vector3i& triangle : more.triangles) {
    mesh->triangles.push_back(triangle + Eigen::Vector3i::Constant(first));
  }
}

}  // namespace splitfusion
