#include "people_scene.h"

#include <algorithm>
#include <map>
#include <utility>

#include "splitfusion/lib/synthetic/detections.h"
#include "splitfusion/lib/synthetic/kinect_noise.h"

namespace splitfusion {
namespace {

constexpr double kFrameRate = 30;

/// Where the people stand, world frame, metres: side by side.
const Eigen::Vector3f kPlaces[PeopleScene::kMost] = {
    {-0.2f, 0.45f, 0}, {0.5f, 0.5f, 0}, {1.15f, 0.3f, 0}, {-0.95f, 0.6f, 0}};

SyntheticOptions OptionsOf(int height) {
  SyntheticOptions options;
  options.height = height;
  options.width = height * 4 / 3;
  return options;
}

PosedSurface ToCamera(const TexturedMesh& rest,
                      const Rigid3d& world_from_camera, TriangleMesh mesh) {
  const Rigid3f camera_from_world = world_from_camera.inverse().cast<float>();
  for (Eigen::Vector3f& v : mesh.vertices) v = camera_from_world * v;
  for (Eigen::Vector3f& n : mesh.normals) n = camera_from_world.linear() * n;
  return {&rest, std::move(mesh.vertices), std::move(mesh.normals)};
}

}  // namespace

PeopleScene::PeopleScene(int people, int height)
    : people_(people),
      options_(OptionsOf(height)),
      camera_(SyntheticCamera(options_)),
      camera_path_(options_),
      room_(MakeRoom(options_.seed)),
      body_(options_.seed) {
  auto& instances = room_.surface.triangle_instances;
  std::fill(instances.begin(), instances.end(), 0);
  for (int i = 0; i < people_; ++i) {
    rest_.push_back(body_.rest());
    auto& own = rest_.back().triangle_instances;
    std::fill(own.begin(), own.end(), i + 1);
  }
}

PosedSurface PeopleScene::Pose(int person, int frame,
                               const Rigid3d& world_from_camera) const {
  constexpr double kDelay = 1.3;  // Between one's gestures and the next one's.
  TriangleMesh mesh;
  mesh.triangles = rest_[person].mesh.triangles;
  mesh.vertices =
      body_.Vertices(motion_.PoseAt(frame / kFrameRate + kDelay * person));
  for (Eigen::Vector3f& v : mesh.vertices) v += kPlaces[person];
  mesh.normals = ComputeVertexNormals(mesh);
  return ToCamera(rest_[person], world_from_camera, std::move(mesh));
}

SyntheticFrame PeopleScene::Render(int frame) const {
  SyntheticFrame result;
  result.world_from_camera = camera_path_.WorldFromCamera(frame / kFrameRate);
  std::vector<PosedSurface> surfaces = {
      ToCamera(room_.surface, result.world_from_camera, room_.surface.mesh)};
  for (int i = 0; i < people_; ++i) {
    surfaces.push_back(Pose(i, frame, result.world_from_camera));
  }
  const RenderedScene rendered =
      RenderSurfaces(surfaces, camera_, result.world_from_camera);
  result.true_depth = rendered.depth;
  result.labels = rendered.label;
  result.frame.index = frame;
  result.frame.timestamp = frame / kFrameRate;
  rendered.color.convertTo(result.frame.color, CV_8UC3, 255);
  result.frame.depth = ApplyKinectNoise(rendered.depth, camera_, frame + 1);
  return result;
}

std::vector<InstanceMask> PeopleScene::Detections(
    const SyntheticFrame& frame) const {
  std::map<int, std::string> class_names;
  for (int i = 0; i < people_; ++i) class_names[i + 1] = "person";
  return ImitateDetections(frame.labels, class_names, ExactDetector(),
                           options_.seed);
}

}  // namespace splitfusion
