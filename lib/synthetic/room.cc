#include "splitfusion/lib/synthetic/room.h"

#include <cmath>
#include <utility>

#include "splitfusion/lib/synthetic/hash_noise.h"

namespace splitfusion {
namespace {

using Eigen::Vector3f;

constexpr float kWallCell = 0.1f;        // Metres.
constexpr float kFurnitureCell = 0.06f;  // Metres.

class RoomBuilder {
 public:
  explicit RoomBuilder(std::uint32_t seed) : seed_(seed) {}

  std::uint16_t AddMaterial(Pattern pattern, const Vector3f& first,
                            const Vector3f& second, float period) {
    auto& materials = room_.surface.materials;
    const auto index = static_cast<std::uint16_t>(materials.size());
    materials.push_back({pattern, first, second, period, seed_ * 131u + index});
    return index;
  }

  /// Everything added from here on has this texture.
  void Use(std::uint16_t material) { material_ = material; }

  void BeginInstance(std::uint8_t instance) { instance_ = instance; }
  void EndInstance() { instance_ = 0; }

  /// A solid that stands on height `bottom`; `size` in metres.
  void Stand(SolidShape shape, float x, float y, float bottom,
             const Vector3f& size, float yaw = 0) {
    Solid solid;
    solid.shape = shape;
    solid.half_size = 0.5f * size;
    solid.center = Vector3f(x, y, bottom + solid.half_size.z());
    solid.yaw = yaw;
    solid.material = material_;
    solid.instance = instance_;
    room_.solids.push_back(solid);
  }

  void AddShell(const Vector3f& low, const Vector3f& high,
                std::uint16_t floor_material, std::uint16_t wall_material);

  Room Finish() && {
    for (std::size_t i = 1; i < room_.solids.size(); ++i) {
      AppendSolid(room_.solids[i], kFurnitureCell, &room_.surface);
    }
    TriangleMesh& mesh = room_.surface.mesh;
    mesh.normals = ComputeVertexNormals(mesh);
    return std::move(room_);
  }

 private:
  std::uint32_t seed_;
  std::uint16_t material_ = 0;
  std::uint8_t instance_ = 0;
  Room room_;
};

void RoomBuilder::AddShell(const Vector3f& low, const Vector3f& high,
                           std::uint16_t floor_material,
                           std::uint16_t wall_material) {
  Solid shell;
  shell.center = 0.5f * (low + high);
  shell.half_size = 0.5f * (high - low);
  shell.inside_out = true;
  shell.material = wall_material;
  room_.solids.push_back(shell);
  TexturedMesh& surface = room_.surface;
  AppendSolid(shell, kWallCell, &surface);
  for (std::size_t i = 0; i < surface.mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = surface.mesh.triangles[i];
    float top = low.z();
    for (int k = 0; k < 3; ++k) {
      top = std::max(top, surface.mesh.vertices[t[k]].z());
    }
    if (top < low.z() + 1e-3f) surface.triangle_materials[i] = floor_material;
  }
}

constexpr auto kBox = SolidShape::kBox;
constexpr auto kCylinder = SolidShape::kCylinder;
constexpr auto kSphere = SolidShape::kSphere;

void AddBookshelf(float x, float y, std::uint32_t seed, RoomBuilder* room) {
  const auto wood = room->AddMaterial(Pattern::kWood, {0.36f, 0.22f, 0.12f},
                                      {0.56f, 0.38f, 0.22f}, 0.09f);
  room->Use(wood);
  const float width = 0.9f, depth = 0.3f, height = 1.8f;
  room->Stand(kBox, x - width / 2, y, 0, {0.03f, depth, height});
  room->Stand(kBox, x + width / 2, y, 0, {0.03f, depth, height});
  for (int level = 0; level <= 4; ++level) {
    room->Stand(kBox, x, y, 0.03f + 0.44f * level, {width, depth, 0.03f});
  }
  const auto books = room->AddMaterial(Pattern::kPosters, {0.75f, 0.3f, 0.2f},
                                       {0.2f, 0.45f, 0.7f}, 0.05f);
  room->Use(books);
  for (int level = 0; level < 4; ++level) {
    float left = x - width / 2 + 0.04f;
    for (int i = 0; left < x + width / 2 - 0.2f; ++i) {
      const float w = 0.06f + 0.12f * HashUnit(i, level, 0, seed);
      const float h = 0.2f + 0.16f * HashUnit(i, level, 1, seed);
      const float d = 0.16f + 0.1f * HashUnit(i, level, 2, seed);
      room->Stand(kBox, left + w / 2, y + 0.13f - d / 2, 0.06f + 0.44f * level,
                  {w, d, h});
      left += w + 0.06f * HashUnit(i, level, 3, seed);
    }
  }
}

void AddSideboard(float x, float y, RoomBuilder* room) {
  room->Use(room->AddMaterial(Pattern::kWood, {0.72f, 0.58f, 0.38f},
                              {0.5f, 0.36f, 0.2f}, 0.12f));
  room->Stand(kBox, x, y, 0.08f, {1.3f, 0.4f, 0.62f});
  room->Stand(kBox, x, y, 0.7f, {1.36f, 0.46f, 0.03f});
  for (const float side : {-0.55f, 0.55f}) {
    room->Stand(kBox, x + side, y, 0, {0.06f, 0.3f, 0.08f});
  }
  room->Use(room->AddMaterial(Pattern::kMottled, {0.75f, 0.7f, 0.6f},
                              {0.4f, 0.3f, 0.25f}, 0.05f));
  for (const float side : {-0.32f, 0.0f, 0.32f}) {
    room->Stand(kSphere, x + side, y - 0.215f, 0.5f, {0.04f, 0.05f, 0.04f});
  }
  room->Use(room->AddMaterial(Pattern::kStripes, {0.15f, 0.4f, 0.6f},
                              {0.85f, 0.85f, 0.75f}, 0.05f));
  room->Stand(kCylinder, x - 0.5f, y, 0.73f, {0.16f, 0.16f, 0.3f});
  room->Use(room->AddMaterial(Pattern::kChecker, {0.8f, 0.25f, 0.2f},
                              {0.9f, 0.75f, 0.3f}, 0.07f));
  room->Stand(kSphere, x - 0.12f, y - 0.02f, 0.73f, {0.24f, 0.24f, 0.24f});
  room->Use(room->AddMaterial(Pattern::kPosters, {0.3f, 0.5f, 0.35f},
                              {0.6f, 0.65f, 0.5f}, 0.08f));
  room->Stand(kBox, x + 0.35f, y + 0.02f, 0.73f, {0.34f, 0.2f, 0.26f}, 0.5f);
}

void AddTable(RoomBuilder* room) {
  const Vector3f top = RoomTableTop();
  room->Use(room->AddMaterial(Pattern::kWood, {0.66f, 0.45f, 0.26f},
                              {0.45f, 0.28f, 0.16f}, 0.1f));
  room->Stand(kBox, top.x(), top.y(), top.z() - 0.04f, {0.56f, 0.56f, 0.04f});
  for (const float dx : {-0.23f, 0.23f}) {
    for (const float dy : {-0.23f, 0.23f}) {
      room->Stand(kBox, top.x() + dx, top.y() + dy, 0,
                  {0.05f, 0.05f, top.z() - 0.04f});
    }
  }
  room->Use(room->AddMaterial(Pattern::kPosters, {0.2f, 0.3f, 0.6f},
                              {0.7f, 0.6f, 0.4f}, 0.06f));
  room->Stand(kBox, top.x() - 0.17f, top.y() + 0.16f, top.z(),
              {0.15f, 0.2f, 0.05f}, 0.4f);
  room->Stand(kCylinder, top.x() + 0.21f, top.y() + 0.2f, top.z(),
              {0.08f, 0.08f, 0.1f});
}

void AddChair(float x, float y, float yaw, RoomBuilder* room) {
  room->BeginInstance(kChairId);
  const auto at = [&](float forward, float left, float bottom,
                      const Vector3f& size) {
    const float c = std::cos(yaw), s = std::sin(yaw);
    room->Stand(kBox, x + c * forward - s * left, y + s * forward + c * left,
                bottom, size, yaw);
  };
  room->Use(room->AddMaterial(Pattern::kChecker, {0.2f, 0.35f, 0.3f},
                              {0.35f, 0.5f, 0.4f}, 0.06f));
  at(0, 0, 0.42f, {0.44f, 0.44f, 0.06f});
  at(-0.2f, 0, 0.62f, {0.04f, 0.42f, 0.34f});
  room->Use(room->AddMaterial(Pattern::kWood, {0.3f, 0.2f, 0.12f},
                              {0.42f, 0.28f, 0.16f}, 0.06f));
  for (const float left : {-0.19f, 0.19f}) {
    at(0.19f, left, 0, {0.045f, 0.045f, 0.42f});
    at(-0.2f, left, 0, {0.045f, 0.045f, 0.64f});
  }
  room->EndInstance();
}

void AddPlantAndLamp(RoomBuilder* room) {
  room->Use(room->AddMaterial(Pattern::kStripes, {0.6f, 0.32f, 0.2f},
                              {0.5f, 0.26f, 0.16f}, 0.06f));
  room->Stand(kCylinder, 1.75f, 1.4f, 0, {0.34f, 0.34f, 0.36f});
  room->Use(room->AddMaterial(Pattern::kMottled, {0.08f, 0.25f, 0.08f},
                              {0.35f, 0.6f, 0.2f}, 0.05f));
  room->Stand(kCylinder, 1.75f, 1.4f, 0.36f, {0.05f, 0.05f, 0.3f});
  room->Stand(kSphere, 1.75f, 1.4f, 0.6f, {0.5f, 0.46f, 0.6f});
  room->Stand(kSphere, 1.6f, 1.25f, 0.8f, {0.26f, 0.26f, 0.3f});
  room->Use(room->AddMaterial(Pattern::kMottled, {0.3f, 0.3f, 0.32f},
                              {0.45f, 0.45f, 0.45f}, 0.05f));
  room->Stand(kCylinder, -1.85f, 0.7f, 0, {0.3f, 0.3f, 0.04f});
  room->Stand(kCylinder, -1.85f, 0.7f, 0.04f, {0.05f, 0.05f, 1.3f});
  room->Use(room->AddMaterial(Pattern::kStripes, {0.9f, 0.8f, 0.5f},
                              {0.8f, 0.65f, 0.35f}, 0.05f));
  room->Stand(kCylinder, -1.85f, 0.7f, 1.3f, {0.4f, 0.4f, 0.3f});
}

void AddWallThings(RoomBuilder* room) {
  room->Use(room->AddMaterial(Pattern::kPosters, {0.7f, 0.55f, 0.3f},
                              {0.3f, 0.4f, 0.6f}, 0.11f));
  room->Stand(kBox, -0.1f, 1.785f, 1.35f, {0.6f, 0.03f, 0.45f});
  room->Stand(kBox, 0.75f, 1.785f, 1.25f, {0.45f, 0.03f, 0.6f});
  room->Stand(kBox, 2.185f, 0.2f, 1.1f, {0.03f, 0.8f, 0.6f});
  room->Stand(kBox, -2.185f, -0.3f, 1.2f, {0.03f, 0.7f, 0.5f});
  room->Use(room->AddMaterial(Pattern::kMottled, {0.75f, 0.72f, 0.68f},
                              {0.6f, 0.58f, 0.55f}, 0.12f));
  room->Stand(kBox, 2.06f, 0.85f, 0, {0.28f, 0.28f, 2.5f});
  room->Stand(kBox, 0, 1.77f, 0, {4.4f, 0.03f, 0.1f});
}

}  // namespace

Vector3f RoomTableTop() { return {-0.9f, -0.02f, 0.66f}; }

Room MakeRoom(std::uint32_t seed) {
  RoomBuilder room(seed);
  const auto floor = room.AddMaterial(Pattern::kChecker, {0.52f, 0.42f, 0.32f},
                                      {0.42f, 0.32f, 0.24f}, 0.3f);
  const auto wall = room.AddMaterial(Pattern::kMottled, {0.72f, 0.7f, 0.6f},
                                     {0.5f, 0.52f, 0.5f}, 0.22f);
  room.AddShell({-2.2f, -2.6f, 0}, {2.2f, 1.8f, 2.5f}, floor, wall);
  AddBookshelf(-1.15f, 1.62f, seed, &room);
  AddSideboard(0.35f, 1.54f, &room);
  AddTable(&room);
  AddChair(1.5f, 0.75f, 3.6f, &room);
  AddPlantAndLamp(&room);
  AddWallThings(&room);
  return std::move(room).Finish();
}

}  // namespace splitfusion
