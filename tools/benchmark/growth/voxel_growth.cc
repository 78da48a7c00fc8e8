// Fusion, re-meshing and ray casting of one frame (SplitFusion IV-D) against
// the voxel size, each as the method does it.

#include <algorithm>

#include "growth_curves.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/render/ray_caster.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"
#include "splitfusion/pipelines/pipeline_options.h"
#include "volumes.h"

namespace splitfusion {
namespace {

/// Frames of a scene as fusion sees them, and where their camera was.
struct LiveFrames {
  LiveFrames(const SyntheticOptions& options, int count, int surface) {
    const SyntheticScene scene(options);
    camera = scene.camera();
    for (int i = 0; i < count; ++i) {
      const SyntheticFrame frame = scene.Render(i);
      views.push_back(
          MakeLiveView(camera, frame.frame.depth, frame.frame.color));
      views.back().labels.setTo(surface, frame.labels == surface);
      camera_from_first.push_back(frame.world_from_camera.inverse() *
                                  scene.WorldFromCamera(0));
    }
  }

  PinholeCamera camera;
  std::vector<LiveView> views;
  std::vector<Rigid3d> camera_from_first;
};

SyntheticOptions SceneOptions(SyntheticSceneKind scene,
                              const GrowthSizes& sizes) {
  SyntheticOptions options;
  options.scene = scene;
  options.height = sizes.height;
  options.width = sizes.height * 4 / 3;
  return options;
}

/// Fuses a frame of the standing room under its exact pose.
double FuseRoom(const LiveFrames& room, std::size_t frame, Surface* surface) {
  *surface->mutable_graph() = MakeRigidGraph(room.camera_from_first[frame]);
  const Stopwatch stopwatch;
  surface->Fuse(room.views[frame]);
  return stopwatch.Seconds();
}

void AddRoomRows(const LiveFrames& room, double voxel_size,
                 GrowthTable* table) {
  const SurfaceOptions options =
      WithVoxels(PipelineOptions().background, voxel_size);
  Surface surface(0, "background", SurfaceKind::kRigid, 0, options);
  surface.Initialize(room.views[0]);
  std::size_t frame = 0;
  const int repetitions = static_cast<int>(room.views.size()) - 1;
  const double fuse =
      Fastest(repetitions, [&] { return FuseRoom(room, ++frame, &surface); });
  const double cast = FastestRun(repetitions, [&] {
    RayCast(surface.volume(), room.camera_from_first[frame], room.camera,
            RayCastOptions());
  });
  const double bytes = VolumeBytes(surface.volume());
  table->rows.push_back({GrowthLabel(voxel_size), "fuse rigid", {fuse, bytes}});
  table->rows.push_back({GrowthLabel(voxel_size), "ray cast", {cast, bytes}});
}

void AddPersonRows(const LiveFrames& person, double voxel_size,
                   GrowthTable* table) {
  const SurfaceOptions options =
      WithVoxels(PipelineOptions().object, voxel_size);
  Surface surface(1, "person", SurfaceKind::kNonRigid, 0, options);
  surface.Initialize(person.views[0]);
  // The first frame skins all blocks and meshes all of them.
  surface.Fuse(person.views[1]);
  surface.UpdateMesh();
  std::size_t frame = 1;
  double mesh = 0;
  const int repetitions = static_cast<int>(person.views.size()) - 2;
  const double fuse = Fastest(repetitions, [&] {
    ++frame;
    Stopwatch stopwatch;
    surface.Fuse(person.views[frame]);
    const double seconds = stopwatch.Restart();
    surface.UpdateMesh();
    mesh =
        frame == 2 ? stopwatch.Seconds() : std::min(mesh, stopwatch.Seconds());
    return seconds;
  });
  const double bytes = VolumeBytes(surface.volume());
  table->rows.push_back(
      {GrowthLabel(voxel_size), "fuse warped", {fuse, bytes}});
  table->rows.push_back({GrowthLabel(voxel_size), "re-mesh", {mesh, bytes}});
}

}  // namespace

GrowthTable VoxelsCurve(const GrowthSizes& sizes) {
  GrowthTable table;
  table.columns = {"voxel_size_m", "series", "seconds", "bytes"};
  const LiveFrames room(SceneOptions(SyntheticSceneKind::kRoom, sizes),
                        sizes.repetitions + 1, /*surface=*/0);
  SyntheticOptions standing = SceneOptions(SyntheticSceneKind::kPerson, sizes);
  standing.camera_motion = 0;
  standing.subject_speed = 0;
  const LiveFrames person(standing, sizes.repetitions + 2, /*surface=*/1);
  for (const double voxel_size : sizes.voxels) {
    AddRoomRows(room, voxel_size, &table);
    AddPersonRows(person, voxel_size, &table);
  }
  return table;
}

}  // namespace splitfusion
