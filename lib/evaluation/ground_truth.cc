#include "splitfusion/lib/evaluation/ground_truth.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tuple>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/format_version.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

std::string IfExists(const fs::path& path) {
  return fs::exists(path) ? path.string() : std::string();
}

/// instK_T.ply, T in seconds; files of other names are not looked at.
std::vector<PosedMeshFile> FindPosedMeshes(const fs::path& folder) {
  std::vector<PosedMeshFile> files;
  if (!fs::is_directory(folder)) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    PosedMeshFile file;
    if (entry.path().extension() == ".ply" &&
        std::sscanf(entry.path().stem().string().c_str(), "inst%d_%lf",
                    &file.instance, &file.timestamp) == 2) {
      file.path = entry.path().string();
      files.push_back(file);
    }
  }
  std::sort(files.begin(), files.end(),
            [](const PosedMeshFile& a, const PosedMeshFile& b) {
              return std::tie(a.instance, a.timestamp) <
                     std::tie(b.instance, b.timestamp);
            });
  return files;
}

/// {"instances": [{"id": 1, "name": "person1", "moving": true, ...}, ...]}
std::map<int, TrueInstance> ReadInstances(const std::string& path) {
  std::map<int, TrueInstance> instances;
  if (path.empty()) return instances;
  std::ifstream stream(path);
  try {
    const auto json = nlohmann::json::parse(stream);
    CheckFormatVersion(path, json);
    for (const auto& item : json.at("instances")) {
      instances[item.at("id").get<int>()] = {item.at("name").get<std::string>(),
                                             item.value("moving", false),
                                             item.value("rigid", false)};
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path + ": expected 'instances' with 'id' and 'name' (" +
                     error.what() + ")");
  }
  return instances;
}

}  // namespace

std::set<int> GroundTruth::MovingInstances() const {
  std::set<int> moving;
  for (const auto& [id, instance] : instances) {
    if (instance.moving) moving.insert(id);
  }
  for (const PosedMeshFile& file : posed_meshes) moving.insert(file.instance);
  return moving;
}

TrueInstance GroundTruth::Find(int instance) const {
  const auto found = instances.find(instance);
  return found != instances.end() ? found->second : TrueInstance();
}

std::string GroundTruthRoot(const std::string& folder) {
  // A sequence may have its trajectory in both, meshes and tracks in gt alone.
  const fs::path below = fs::path(folder) / "gt";
  return fs::exists(below / "groundtruth.txt") ? below.string() : folder;
}

std::vector<std::string> GroundTruthFiles(const std::string& folder) {
  const fs::path root = GroundTruthRoot(folder);
  std::vector<std::string> files;
  for (const char* name :
       {"groundtruth.txt", "labels.json", "static_mesh.ply", "tracks.bin"}) {
    if (fs::is_regular_file(root / name)) files.emplace_back(name);
  }
  for (const char* name : {"label", "mesh"}) {
    if (!fs::is_directory(root / name)) continue;
    for (const auto& entry : fs::directory_iterator(root / name)) {
      if (!entry.is_regular_file()) continue;
      files.push_back(std::string(name) + "/" +
                      entry.path().filename().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

GroundTruth ReadGroundTruth(const std::string& folder) {
  const fs::path root = GroundTruthRoot(folder);
  if (!fs::exists(root / "groundtruth.txt")) {
    throw InputError(folder +
                     ": expected a folder with groundtruth.txt (or "
                     "gt/groundtruth.txt)");
  }
  GroundTruth truth;
  truth.folder = root.string();
  truth.trajectory = ReadTumTrajectory((root / "groundtruth.txt").string());
  if (truth.trajectory.empty()) {
    throw InputError((root / "groundtruth.txt").string() + ": no pose");
  }
  truth.static_mesh = IfExists(root / "static_mesh.ply");
  truth.tracks = IfExists(root / "tracks.bin");
  truth.labels = IfExists(root / "label");
  truth.posed_meshes = FindPosedMeshes(root / "mesh");
  truth.instances = ReadInstances(IfExists(root / "labels.json"));
  return truth;
}

}  // namespace splitfusion
