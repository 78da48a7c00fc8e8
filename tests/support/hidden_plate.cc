#include "support/hidden_plate.h"

#include "support/motion_frames.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {

std::map<int, Rigid3d> Poses(const std::vector<int>& frames) {
  std::map<int, Rigid3d> poses;
  for (const int frame : frames) {
    poses[frame] =
        MakeMotion({0, 0.01 * frame, 0}, {0.02 * frame, 0, 0.01 * frame});
  }
  return poses;
}

std::vector<int> FramesUpTo(int last) {
  std::vector<int> frames;
  for (int frame = 0; frame <= last; ++frame) frames.push_back(frame);
  return frames;
}

SurfaceModel SeenPlate(const std::map<int, Rigid3d>& poses,
                       const PlateMap& map) {
  SurfaceModel model;
  model.mesh = PlateMesh(0.3, 0.2, 0.02, 1);
  model.graph = CoverWithNodes(model.mesh, 0.05);
  for (const auto& [frame, pose] : poses) {
    DeformationGraph graph = model.graph;
    MoveNodes([&, index = frame, view = pose.inverse()](
                  const Eigen::Vector3d& p) { return view * map(p, index); },
              &graph);
    model.history.Append(
        {frame, true, graph.motions, std::vector<char>(graph.size(), true)});
  }
  return model;
}

void Hide(int first, int last, const std::function<bool(int)>& is_hidden,
          SurfaceModel* model) {
  const std::vector<NodeMotion> before =
      model->history.Find(first - 1)->motions;
  EditFrames(
      [&](FrameMotions& frame) {
        if (frame.frame < first || frame.frame > last) return;
        for (int i = 0; i < model->graph.size(); ++i) {
          if (!is_hidden(i)) continue;
          frame.seen[i] = false;
          frame.motions[i] = before[i];
        }
      },
      &model->history);
}

Eigen::Vector3d Walk(const Eigen::Vector3d& p, int frame) {
  return p + Eigen::Vector3d(0.03 * frame, 0.0005 * frame * frame, 0);
}

}  // namespace splitfusion
