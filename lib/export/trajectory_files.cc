#include "splitfusion/lib/export/trajectory_files.h"

#include <iomanip>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/sequence/trajectory.h"

namespace splitfusion {

void WriteTumPoses(const std::string& path, const ExportScene& scene) {
  Trajectory trajectory;
  for (const ExportFrame& frame : scene.frames) {
    trajectory.push_back({frame.timestamp, frame.world_from_camera});
  }
  WriteTumTrajectory(path, trajectory);
}

void WriteKittiPoses(const std::string& path, const ExportScene& scene) {
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << std::setprecision(9);
    for (const ExportFrame& frame : scene.frames) {
      for (int i = 0; i < 12; ++i) {  // Format.
        out << (i == 0 ? "" : " ") << frame.world_from_camera(i / 4, i % 4);
      }
      out << '\n';
    }
  });
}

}  // namespace splitfusion
