// Writes a finished run in the formats of other programs.

#include <gflags/gflags.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/pending_folder.h"
#include "splitfusion/lib/export/appearance.h"
#include "splitfusion/lib/export/export_scene.h"
#include "splitfusion/lib/export/gltf_scene.h"
#include "splitfusion/lib/export/mesh_sequence.h"
#include "splitfusion/lib/export/point_cache.h"
#include "splitfusion/lib/export/run_arrays.h"
#include "splitfusion/lib/export/trajectory_files.h"
#include "tool_main.h"

DEFINE_string(output, "", "File to write; a folder for ply, obj and pcd.");
DEFINE_string(as, "",
              "glb, pc2, npz, ply, obj, pcd, tum or kitti; by default what the "
              "ending of --output says (of a folder, DIR/: ply).");
DEFINE_string(surfaces, "", "Ids of surfaces, as in 0,2; default: all.");
DEFINE_int32(every, 1, "Every n-th frame.");
DEFINE_string(space, "world",
              "world, or camera: in every frame that of the camera, as in "
              "warped/.");
DEFINE_bool(refuted, true,
            "Also parts of surfaces that were refuted later, while they were "
            "in use.");
DEFINE_bool(cut_stretched, true,
            "Without triangles that are stretched in some frame.");
DEFINE_int32(
    grow, 10,
    "glb: what was seen later appears when it was seen, in steps of so "
    "many frames; ply, obj: triangles of what had been seen by the "
    "frame alone; 0: the whole mesh in all frames.");
DEFINE_int32(influences, 8, "glb: most nodes that carry a vertex, 4 or 8.");
DEFINE_bool(bake, false,
            "glb: a shape for every frame (morph targets), no joints.");
DEFINE_bool(unlit, true, "glb: colours as they are, without light.");
DEFINE_bool(overwrite, false, "Replace an earlier folder of this program.");

namespace splitfusion {
namespace {

constexpr char kUsage[] =
    "Writes a finished run in the formats of other programs.\n"
    "  sf_export RUN --output=FILE.glb    animated glTF 2.0\n"
    "  sf_export RUN --output=NAME.pc2    NAME_SURFACE.pc2 and .obj, for "
    "Blender\n"
    "  sf_export RUN --output=FILE.npz    meshes, nodes, motions, for NumPy\n"
    "  sf_export RUN --output=DIR/ [--as=ply|obj|pcd]  a file a frame and "
    "surface\n"
    "  sf_export RUN --output=FILE.txt --as=tum|kitti  poses of the camera\n";

constexpr char kKinds[] = "glb, pc2, npz, ply, obj, pcd, tum or kitti";

/// Kinds that are a folder of files.
const std::map<std::string, MeshFileKind>& SequenceKinds() {
  static const std::map<std::string, MeshFileKind> kinds = {
      {"ply", MeshFileKind::kPly},
      {"obj", MeshFileKind::kObj},
      {"pcd", MeshFileKind::kPcd}};
  return kinds;
}

/// The kind that --as says, or the name of the output.
std::string Kind() {
  if (!FLAGS_as.empty()) return FLAGS_as;
  const std::filesystem::path path(FLAGS_output);
  if (path.filename().empty()) return "ply";
  const std::string extension = path.extension().string();
  for (const char* kind : {"glb", "pc2", "npz"}) {
    if (extension == std::string(".") + kind) return kind;
  }
  throw OptionError("output", "'" + FLAGS_output + "'",
                    "a name that ends in .glb, .pc2, .npz or /, or --as");
}

/// Ids of --surfaces.
std::vector<int> SurfaceIds() {
  std::vector<int> ids;
  std::string digits;
  for (const char c : FLAGS_surfaces + ",") {
    if (c >= '0' && c <= '9' && digits.size() < 9) {
      digits += c;
      continue;
    }
    if (c == ',' && FLAGS_surfaces.empty()) break;
    CheckOption(c == ',' && !digits.empty(), "surfaces",
                "'" + FLAGS_surfaces + "'", "ids of surfaces, as in 0,2");
    ids.push_back(std::stoi(digits));
    digits.clear();
  }
  return ids;
}

ExportOptions Options(const std::string& kind) {
  CheckOption(FLAGS_space == "world" || FLAGS_space == "camera", "space",
              "'" + FLAGS_space + "'", "world or camera");
  CheckOption(FLAGS_grow >= 0, "grow", FLAGS_grow, ">= 0");
  ExportOptions options;
  options.every = FLAGS_every;
  options.surfaces = SurfaceIds();
  options.in_world = FLAGS_space == "world";
  options.y_up = kind == "glb" || kind == "pc2" || kind == "obj";
  options.refuted = FLAGS_refuted;
  const bool poses = kind == "tum" || kind == "kitti";
  options.cut_stretched = FLAGS_cut_stretched && !poses;
  return options;
}

void SayWhatIsLeftOut(const ExportScene& scene) {
  for (const std::string& name : scene.absent) {
    std::cout << name << " is left out: no vertex, or in none of the frames\n";
  }
  std::size_t left_out = 0, shown = 0;
  for (const ExportSurface& surface : scene.surfaces) {
    left_out += static_cast<std::size_t>(surface.stretched_triangles);
    shown += surface.mesh.triangles.size();
  }
  if (left_out == 0) return;
  std::cout << left_out << " of " << left_out + shown
            << " triangles are left out, as they are stretched in some frame\n";
}

/// Cuts the surfaces of a scene into pieces that appear one after another.
void LetGrow(ExportScene* scene) {
  std::vector<ExportSurface> pieces;
  for (ExportSurface& surface : scene->surfaces) {
    for (ExportSurface& piece : SplitByAppearance(surface, FLAGS_grow)) {
      pieces.push_back(std::move(piece));
    }
    surface = {};  // Its motions take much memory.
  }
  scene->surfaces = std::move(pieces);
}

void ExportGlb(ExportScene scene, const GltfOptions& options) {
  if (FLAGS_grow > 0) LetGrow(&scene);
  const InfluenceError error = WriteGltf(FLAGS_output, scene, options);
  if (options.bake || options.influences == 8) return;
  std::printf(
      "%d influences: vertices are %.3f mm (root mean square), at "
      "most %.3f mm, from where all nodes carry them\n",
      options.influences, 1000 * error.RootMeanSquare(), 1000 * error.largest);
  std::fflush(stdout);
}

void ExportCaches(const ExportScene& scene) {
  std::filesystem::path stem(FLAGS_output);
  if (stem.extension() == ".pc2") stem.replace_extension();
  for (const auto& files : WritePointCaches(stem.string(), scene)) {
    std::cout << files.mesh << '\n';
    if (files.cache.empty()) continue;
    std::cout << files.cache << ": " << files.frames << " frames, Frame Start "
              << files.start << '\n';
  }
}

void ExportSequence(const ExportScene& scene, MeshFileKind kind) {
  PendingFolder folder(FLAGS_output, "sf_export", FLAGS_overwrite);
  const int files =
      WriteMeshSequence(folder.path().string(), scene, kind, FLAGS_grow > 0);
  folder.Commit();
  std::cout << FLAGS_output << ": " << files << " files\n";
}

void Export(const std::string& kind, const std::string& run,
            const GltfOptions& gltf) {
  ExportScene scene = ReadExportScene(run, Options(kind));
  if (kind == "tum") return WriteTumPoses(FLAGS_output, scene);
  if (kind == "kitti") return WriteKittiPoses(FLAGS_output, scene);
  SayWhatIsLeftOut(scene);
  if (kind == "npz") return WriteRunArrays(FLAGS_output, scene);
  if (kind == "glb") return ExportGlb(std::move(scene), gltf);
  if (kind == "pc2") return ExportCaches(scene);
  ExportSequence(scene, SequenceKinds().at(kind));
}

int Run(const std::vector<std::string>& arguments) {
  CheckOption(arguments.size() == 1, "RUN", arguments.size(),
              "one run directory");
  CheckOption(!FLAGS_output.empty(), "output", "''", "what to write");
  CheckIsNoFileOfARun(FLAGS_output);
  const std::string kind = Kind();
  const bool known = kind == "glb" || kind == "pc2" || kind == "npz" ||
                     kind == "tum" || kind == "kitti" ||
                     SequenceKinds().count(kind) > 0;
  CheckOption(known, "as", "'" + kind + "'", kKinds);
  GltfOptions gltf;
  gltf.influences = FLAGS_influences;
  gltf.bake = FLAGS_bake;
  gltf.unlit = FLAGS_unlit;
  gltf.Check();
  Export(kind, arguments.front(), gltf);
  return kExitDone;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  std::vector<std::string> arguments;
  return splitfusion::ToolMain(
      argc, argv, splitfusion::kUsage,
      [&] { return splitfusion::Run(arguments); }, "", &arguments);
}
