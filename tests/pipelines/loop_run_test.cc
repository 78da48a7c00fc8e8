// A camera that turns once around, with wrong focal lengths.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <stdexcept>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/pi.h"
#include "splitfusion/lib/sequence/trajectory.h"
#include "splitfusion/pipelines/reconstruction.h"
#include "splitfusion/pipelines/sequence_run.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

constexpr int kTurnFrames = 80;
constexpr double kTurnStep = 5 * kPi<double> / 180;
const cv::Size kTurnImage(240, 180);
constexpr double kTrueFocal = 200;
/// Half of a room's length, width and height, metres.
const Eigen::Vector3d kHalfRoom(1.6, 1.2, 2.0);

Rigid3d TurnedCamera(int frame) {
  Rigid3d pose = Rigid3d::Identity();
  pose.linear() = ExpSo3({0, kTurnStep * frame, 0});
  return pose;
}

/// Blots of a wall paper.
cv::Mat_<std::uint8_t> WallPaper() {
  cv::Mat_<std::uint8_t> paper(1024, 1024, std::uint8_t{128});
  std::mt19937 random(5);
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  for (int i = 0; i < 1500; ++i) {
    cv::circle(paper, {below(1024), below(1024)}, 4 + below(16), below(256),
               cv::FILLED);
  }
  return paper;
}

/// Depth, metres, and grey of the wall that a ray of the world hits; a shelf
/// sticks out of every wall.
std::pair<double, int> LookAtRoom(const Eigen::Vector3d& ray,
                                  const cv::Mat_<std::uint8_t>& paper) {
  double depth = 0;
  int wall = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double along = kHalfRoom[axis] / std::abs(ray[axis]);
    if (axis > 0 && along >= depth) continue;
    depth = along;
    wall = 2 * axis + (ray[axis] > 0);
  }
  Eigen::Vector3d hit = depth * ray;
  const int axis = wall / 2;
  const double across = hit[(axis + 1) % 3] + 0.2 * wall;
  if (axis != 1 && std::abs(across) < 0.3) hit = 0.85 * hit;
  const int u = static_cast<int>(200 * (hit[(axis + 1) % 3] + 2.2));
  const int v = static_cast<int>(200 * (hit[(axis + 2) % 3] + 2.2));
  return {hit.norm() / ray.norm(),
          paper((v + 170 * wall) % 1024, (u + 290 * wall) % 1024)};
}

/// Writes the sequence in the layout of the TUM benchmark.
void WriteTurn(const TemporaryFolder& folder, double focal) {
  const cv::Mat_<std::uint8_t> paper = WallPaper();
  std::string list;
  for (const char* name : {"/rgb", "/depth"}) {
    std::filesystem::create_directories((folder / "turn") + name);
  }
  for (int i = 0; i < kTurnFrames; ++i) {
    cv::Mat_<std::uint16_t> depth(kTurnImage);
    cv::Mat_<std::uint8_t> grey(kTurnImage);
    for (int v = 0; v < depth.rows; ++v) {
      for (int u = 0; u < depth.cols; ++u) {
        const Eigen::Vector3d ray((u - 119.5) / kTrueFocal,
                                  (v - 89.5) / kTrueFocal, 1);
        const auto [z, shade] =
            LookAtRoom(TurnedCamera(i).linear() * ray, paper);
        depth(v, u) = cv::saturate_cast<std::uint16_t>(5000 * z);
        grey(v, u) = static_cast<std::uint8_t>(shade);
      }
    }
    cv::Mat color;
    cv::cvtColor(grey, color, cv::COLOR_GRAY2BGR);
    const std::string time = cv::format("%.6f", 100 + i / 30.0);
    cv::imwrite((folder / "turn/rgb/") + time + ".png", color);
    cv::imwrite((folder / "turn/depth/") + time + ".png", depth);
    list +=
        time + " rgb/" + time + ".png " + time + " depth/" + time + ".png\n";
  }
  folder.Write("turn/associations.txt", list);
  folder.Write("turn/camera.txt",
               cv::format("width 240\nheight 180\nfx %g\nfy %g\ncx 119.5\n"
                          "cy 89.5\ndepth_scale 5000\n",
                          focal, focal));
}

class LoopRun : public ::testing::Test {
 protected:
  LoopRun() {
    options_.render_stride = 1;
    options_.key_frames.agreeing = 15;  // Of small images.
    run_options_.pictures_every = 0;
  }

  /// False if it was interrupted.
  bool Execute(const std::string& run, const SequenceRunHooks& hooks = {}) {
    const auto make = [this] {
      return std::make_unique<Reconstruction>(
          folder_ / "turn", ReaderOptions(), options_, LabelTable(),
          [](const ImageFolderReader&) { return nullptr; });
    };
    RunFolder folder(folder_ / run, {{{"run", "turn"}}, {}}, {});
    SequenceRun sequence_run(make(), make, &folder, run_options_, hooks);
    try {
      sequence_run.Execute();
    } catch (const std::runtime_error&) {
      return false;
    }
    return true;
  }

  nlohmann::json Loops(const std::string& run) const {
    return nlohmann::json::parse(folder_.Read(run + "/summary.json"))["loops"];
  }

  void ExpectSame(const std::string& run, const std::string& other) const {
    for (const char* file :
         {"trajectory.txt", "surfaces/000_background/mesh.ply"}) {
      EXPECT_TRUE(folder_.Read(run + "/" + file) ==
                  folder_.Read(other + "/" + file))
          << file;
    }
  }

  /// Largest angle by which a camera is off, radians.
  double LargestTurnError(const std::string& run) const {
    const Trajectory found =
        ReadTumTrajectory((folder_ / run) + "/trajectory.txt");
    double largest = 0;
    for (int i = 0; i < kTurnFrames; ++i) {
      const Rigid3d off =
          found.at(i).world_from_camera.inverse() * TurnedCamera(i);
      largest = std::max(largest, RotationAngle(off.linear()));
    }
    return largest;
  }

  TemporaryFolder folder_;
  PipelineOptions options_;
  SequenceRunOptions run_options_;
};

/// Interrupts a run, or lets it fail, after so many frames of a pass over them;
/// passes count that it begins itself.
SequenceRunHooks StopAt(int pass, int frame, bool fails) {
  const auto begun = std::make_shared<int>(0), done = std::make_shared<int>(0);
  const auto is_there = [=] { return *begun == pass && *done == frame; };
  SequenceRunHooks hooks;
  hooks.shown = [=](const RunProgress& progress) {
    if (progress.pass != RunPass::kTracking) return;
    *begun += progress.done == 1;
    *done = progress.done;
    if (fails && is_there()) throw InputError("disk on fire");
  };
  hooks.interrupted = [=] { return !fails && is_there(); };
  return hooks;
}

TEST_F(LoopRun, ACameraThatTurnsAroundComesBack) {
  WriteTurn(folder_, 1.05 * kTrueFocal);
  options_.close_loops = false;
  ASSERT_TRUE(Execute("open"));
  EXPECT_EQ(Loops("open")["key_frames"], 0);
  options_.close_loops = true;
  ASSERT_TRUE(Execute("closed"));
  const nlohmann::json loops = Loops("closed");
  EXPECT_GE(loops["kept"], 3);
  EXPECT_TRUE(loops["fused_anew"]);
  EXPECT_LT(LargestTurnError("closed"), 0.5 * LargestTurnError("open"));
}

TEST_F(LoopRun, WithoutDriftNothingChanges) {
  WriteTurn(folder_, kTrueFocal);
  options_.close_loops = false;
  ASSERT_TRUE(Execute("open"));
  options_.close_loops = true;
  ASSERT_TRUE(Execute("closed"));
  EXPECT_GE(Loops("closed")["kept"], 3);
  EXPECT_FALSE(Loops("closed")["fused_anew"]);
  ExpectSame("open", "closed");
}

TEST_F(LoopRun, TheSecondPassGoesOnWhereItWasStopped) {
  WriteTurn(folder_, 1.05 * kTrueFocal);
  ASSERT_TRUE(Execute("whole"));
  run_options_.checkpoint_every = 7;
  EXPECT_FALSE(Execute("stopped", StopAt(2, 5, /*fails=*/false)));
  EXPECT_FALSE(Execute("stopped", StopAt(0, 25, /*fails=*/true)));
  ASSERT_TRUE(Execute("stopped"));
  EXPECT_EQ(Loops("whole"), Loops("stopped"));
  ExpectSame("whole", "stopped");
}

}  // namespace
}  // namespace splitfusion
