#include "splitfusion/lib/export/gltf_scene.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/export/gltf_animation.h"
#include "splitfusion/lib/export/gltf_mesh.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

/// Writes the parts of a scene, one after another.
class GltfWriter {
 public:
  GltfWriter(const ExportScene& scene, const GltfOptions& options)
      : scene_(scene), options_(options), animation_(scene, &file_) {
    AddHead();
  }

  void AddCamera();
  void AddSurface(const ExportSurface& surface);
  void Write(const std::string& path);

  const InfluenceError& error() const { return error_; }

 private:
  void AddHead();
  /// A node of the scene itself; returns its index.
  int AddRoot(Json node);
  void AddStill(const ExportSurface& surface);
  void AddRigid(const ExportSurface& surface);
  void AddSkinned(const ExportSurface& surface);
  void AddBaked(const ExportSurface& surface);
  int AddMesh(const ExportSurface& surface, Json primitive);
  /// Nodes of the graph; returns the indices of glTF.
  std::vector<int> AddJoints(const ExportSurface& surface, int times);
  /// The joint above them, and above that the node of the scene.
  int AddRootJoint(const ExportSurface& surface,
                   const std::vector<int>& joints);
  int AddSkin(const ExportSurface& surface, const std::vector<int>& joints);
  int AddTimesOf(const ExportSurface& surface);
  Json ExtrasOf(const ExportSurface& surface) const;

  const ExportScene& scene_;
  const GltfOptions& options_;
  GlbFile file_;
  GltfAnimation animation_;
  InfluenceError error_;
};

void GltfWriter::AddHead() {
  file_.json = {
      {"asset", {{"version", "2.0"}, {"generator", "sf_export"}}},
      {"scene", 0},
      {"scenes", Json::array()},
      {"nodes", Json::array()},
      {"meshes", Json::array()},
      {"materials", Json::array()},
  };
  file_.json["scenes"].push_back({{"name", "run"}, {"nodes", Json::array()}});
  Json material = {
      {"name", "vertex colors"},
      {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}},
      {"doubleSided", true}};
  if (options_.unlit) {
    file_.json["extensionsUsed"] = {"KHR_materials_unlit"};
    material["extensions"]["KHR_materials_unlit"] = Json::object();
  }
  file_.Append("materials", material);
}

int GltfWriter::AddRoot(Json node) {
  const int index = file_.Append("nodes", std::move(node));
  file_.json["scenes"][0]["nodes"].push_back(index);
  return index;
}

void GltfWriter::AddCamera() {
  // Looks along -z, y up.
  const Eigen::Quaterniond turned(
      Eigen::Matrix3d(Eigen::Vector3d(1, -1, -1).asDiagonal()));
  std::vector<GltfPose> poses;
  std::vector<std::size_t> places;
  for (const ExportFrame& frame : scene_.frames) {
    places.push_back(places.size());
    const Rigid3d& pose = frame.space_from_camera;
    const Eigen::Quaterniond turn(pose.linear());
    poses.push_back({pose.translation(), (turn * turned).normalized()});
  }
  Json node = {{"name", "camera"}};
  if (scene_.camera) {
    const PinholeCamera& camera = *scene_.camera;
    file_.Append("cameras",
                 {{"name", "camera"},
                  {"type", "perspective"},
                  {"perspective",
                   {{"aspectRatio",
                     camera.width * camera.fy / (camera.height * camera.fx)},
                    {"yfov", 2 * std::atan(camera.height / (2 * camera.fy))},
                    {"znear", kNearPlane}}}});
    node["camera"] = 0;
  }
  poses.front().SetNode(&node);
  const int index = AddRoot(std::move(node));
  if (scene_.in_world)
    animation_.Move(index, animation_.AddTimes(places), poses);
}

void GltfWriter::AddSurface(const ExportSurface& surface) {
  if (surface.mesh.triangles.empty()) return;
  if (surface.graph.rigid()) {
    surface.IsStill(scene_.frames.size()) ? AddStill(surface)
                                          : AddRigid(surface);
  } else if (options_.bake) {
    AddBaked(surface);
  } else {
    AddSkinned(surface);
  }
}

Json GltfWriter::ExtrasOf(const ExportSurface& surface) const {
  return {{"surface", surface.id},
          {"label", surface.label},
          {"first_frame", surface.moments.front().frame},
          {"last_frame", surface.moments.back().frame},
          {"stretched_triangles", surface.stretched_triangles}};
}

int GltfWriter::AddMesh(const ExportSurface& surface, Json primitive) {
  AddSource(surface.source, &file_, &primitive);
  Json mesh = {{"name", surface.name}, {"primitives", Json::array()}};
  mesh["primitives"].push_back(std::move(primitive));
  return file_.Append("meshes", std::move(mesh));
}

int GltfWriter::AddTimesOf(const ExportSurface& surface) {
  std::vector<std::size_t> places;
  for (const ExportMoment& moment : surface.moments) {
    places.push_back(moment.place);
  }
  return animation_.AddTimes(places);
}

void GltfWriter::AddStill(const ExportSurface& surface) {
  const TriangleMesh placed = surface.At(surface.moments.front());
  AddRoot({{"name", surface.name},
           {"mesh", AddMesh(surface, AddPrimitive(placed, &file_))},
           {"extras", ExtrasOf(surface)}});
}

void GltfWriter::AddRigid(const ExportSurface& surface) {
  // About its node, so that it turns about that between frames.
  TriangleMesh mesh = surface.mesh;
  const Eigen::Vector3f node = surface.graph.positions[0].cast<float>();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex -= node;
  std::vector<GltfPose> poses;
  for (const ExportMoment& moment : surface.moments) {
    poses.push_back(PoseOfNode(surface, moment, 0));
  }
  Json object = {{"name", surface.name},
                 {"mesh", AddMesh(surface, AddPrimitive(mesh, &file_))},
                 {"extras", ExtrasOf(surface)}};
  poses.front().SetNode(&object);
  const int index = AddRoot(std::move(object));
  animation_.Move(index, AddTimesOf(surface), poses);
  animation_.ShowWithin(index, surface.moments);
}

std::vector<int> GltfWriter::AddJoints(const ExportSurface& surface,
                                       int times) {
  std::vector<int> joints;
  for (int i = 0; i < surface.graph.size(); ++i) {
    std::vector<GltfPose> poses;
    for (const ExportMoment& moment : surface.moments) {
      poses.push_back(PoseOfNode(surface, moment, i));
    }
    Json joint = {{"name", surface.name + "_node_" + std::to_string(i)}};
    poses.front().SetNode(&joint);
    joints.push_back(file_.Append("nodes", std::move(joint)));
    animation_.Move(joints.back(), times, poses);
  }
  return joints;
}

int GltfWriter::AddRootJoint(const ExportSurface& surface,
                             const std::vector<int>& joints) {
  const int root = file_.Append(
      "nodes", {{"name", surface.name + "_nodes"}, {"children", joints}});
  AddRoot({{"name", surface.name + "_graph"}, {"children", {root}}});
  animation_.ShowWithin(root, surface.moments);
  return root;
}

int GltfWriter::AddSkin(const ExportSurface& surface,
                        const std::vector<int>& joints) {
  // The root is the last. It carries no vertex, but Blender takes the rest pose
  // of a bone from these matrices only if its parent has one, too; else it
  // blends vertices twice.
  std::vector<Eigen::Vector3d> places = surface.graph.positions;
  places.push_back(Eigen::Vector3d::Zero());
  std::vector<float> inverse_binds;
  for (const Eigen::Vector3d& g : places) {
    Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
    matrix.topRightCorner<3, 1>() = -g.cast<float>();
    inverse_binds.insert(inverse_binds.end(), matrix.data(),
                         matrix.data() + matrix.size());  // By columns.
  }
  return file_.Append(
      "skins", {{"name", surface.name},
                {"inverseBindMatrices", file_.Add(inverse_binds, {"MAT4"})},
                {"joints", joints}});
}

void GltfWriter::AddSkinned(const ExportSurface& surface) {
  if (surface.graph.size() >= std::numeric_limits<std::uint16_t>::max()) {
    throw InputError(surface.name + ": " +
                     std::to_string(surface.graph.size()) +
                     " nodes: expected at most 65534 for glTF, or --bake");
  }
  const std::vector<Skinning> skinning =
      HeaviestFirst(surface.skinning, options_.influences);
  error_ += ErrorOf(surface, skinning);
  Json primitive = AddPrimitive(surface.mesh, &file_);
  AddSkinning(skinning, &file_, &primitive);
  std::vector<int> joints = AddJoints(surface, AddTimesOf(surface));
  joints.push_back(AddRootJoint(surface, joints));
  AddRoot({{"name", surface.name},
           {"mesh", AddMesh(surface, std::move(primitive))},
           {"skin", AddSkin(surface, joints)},
           {"extras", ExtrasOf(surface)}});
}

void GltfWriter::AddBaked(const ExportSurface& surface) {
  const TriangleMesh base = surface.At(surface.moments.front());
  Json primitive = AddPrimitive(base, &file_);
  const std::size_t targets = surface.moments.size() - 1;
  Json names = Json::array();
  std::vector<float> weights((targets + 1) * targets, 0);
  for (std::size_t i = 0; i < targets; ++i) {
    const ExportMoment& moment = surface.moments[i + 1];
    AddTarget(base, surface.At(moment), &file_, &primitive);
    names.push_back("frame_" + RunPaths::FrameName(moment.frame));
    weights[(i + 1) * targets + i] = 1;
  }
  const int mesh = AddMesh(surface, std::move(primitive));
  const int index = AddRoot(
      {{"name", surface.name}, {"mesh", mesh}, {"extras", ExtrasOf(surface)}});
  animation_.ShowWithin(index, surface.moments);
  if (targets == 0) return;
  file_.json["meshes"][mesh]["extras"]["targetNames"] = names;
  file_.json["meshes"][mesh]["weights"] = std::vector<float>(targets, 0);
  animation_.Morph(index, AddTimesOf(surface), weights);
}

void GltfWriter::Write(const std::string& path) {
  animation_.Finish();
  file_.json["asset"]["extras"] = {
      {"first_timestamp", scene_.frames.front().timestamp},
      {"influence_error_rms", error_.RootMeanSquare()},
      {"influence_error_largest", error_.largest}};
  for (const char* list : {"meshes", "nodes"}) {
    if (file_.json[list].empty()) file_.json.erase(list);
  }
  file_.Write(path);
}

}  // namespace

void GltfOptions::Check() const {
  CheckOption(influences == 4 || influences == 8, "influences", influences,
              "4 or 8");
}

InfluenceError WriteGltf(const std::string& path, const ExportScene& scene,
                         const GltfOptions& options) {
  options.Check();
  GltfWriter writer(scene, options);
  writer.AddCamera();
  for (const ExportSurface& surface : scene.surfaces) {
    writer.AddSurface(surface);
  }
  writer.Write(path);
  return writer.error();
}

}  // namespace splitfusion
