#include "support/joined_run.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "splitfusion/lib/deformation/graph_file.h"
#include "splitfusion/lib/deformation/motion_file.h"
#include "splitfusion/lib/evaluation/recorded_run.h"
#include "support/motion_frames.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

void WriteFiles(const std::string& folder, const RecordedSurface& surface) {
  std::filesystem::create_directories(folder);
  WritePly(folder + "/mesh.ply", surface.mesh);
  WriteGraph(folder + "/graph.json", surface.graph,
             surface.neighbors_per_point);
  WriteMotions(folder + "/motions.bin", surface.motions, surface.graph.size());
  std::ofstream(folder + "/tsdf.vdb") << std::string(" BDV\0\0\0\0", 8);
}

/// Appends a copy of a surface, `aside` along x of the canonical frame.
void AppendCopy(const RecordedSurface& one, double aside,
                RecordedSurface* all) {
  const Eigen::Vector3d shift(aside, 0, 0);
  const int nodes = all->graph.size();
  TriangleMesh mesh = one.mesh;
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex += shift.cast<float>();
  AppendMesh(mesh, &all->mesh);
  for (const Eigen::Vector3d& g : one.graph.positions) {
    all->graph.positions.push_back(g + shift);
  }
  for (std::vector<int> neighbors : one.graph.neighbors) {
    for (int& node : neighbors) node += nodes;
    all->graph.neighbors.push_back(neighbors);
  }
  EditFrames(
      [&](FrameMotions& frame) {
        const FrameMotions own = *one.motions.Find(frame.frame);
        for (NodeMotion motion : own.motions) {
          motion.translation -= shift;
          frame.motions.push_back(motion);
        }
      },
      &all->motions);
}

RecordedSurface Joined(const RecordedSurface& one) {
  RecordedSurface all = one;
  all.mesh = {};
  all.graph.positions.clear();
  all.graph.neighbors.clear();
  all.graph.motions.clear();
  all.graph.first_seen.clear();
  EditFrames(
      [](FrameMotions& frame) {
        frame.motions.clear();
        frame.seen.clear();
      },
      &all.motions);
  for (int part = 0; part < 3; ++part) AppendCopy(one, part, &all);
  const int nodes = one.graph.size();
  all.graph.parts = {{0, 1, 3}, {nodes, 1, 6}, {2 * nodes, 6}};
  return all;
}

RecordedSurface Ball() {
  RecordedSurface ball;
  ball.mesh = PlateMesh(0.1, 0.1, 0.05, 1);
  ball.graph = MakeRigidGraph(Rigid3d::Identity());
  ball.neighbors_per_point = 1;
  for (int frame = 4; frame <= 8; ++frame) {
    NodeMotion motion;
    motion.translation.x() = 0.01 * frame;
    ball.motions.Append({frame, true, {motion}});
  }
  return ball;
}

}  // namespace

void JoinedRun::Write(const std::string& folder) const {
  plate.WriteRun(folder);
  const std::string thin = folder + "/surfaces/001_thin_plate";
  WriteFiles(thin, Joined(ReadRecordedSurface(thin)));
  WriteFiles(folder + "/surfaces/002_ball", Ball());
  std::ofstream lines(folder + "/frames.jsonl");
  for (int frame = 0; frame < plate.frames; ++frame) {
    const char* state = frame == 8 ? "inactive" : "tracked";
    nlohmann::json line = {{"frame", frame}, {"stem", BentPlate::Stem(frame)}};
    line["surfaces"].push_back({{"id", 1}, {"state", state}});
    lines << line << '\n';
  }
}

}  // namespace splitfusion
