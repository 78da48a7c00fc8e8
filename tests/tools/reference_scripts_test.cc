// sf_evaluate agrees with scripts that were written by others, without its
// code.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "splitfusion/lib/deformation/motion_file.h"
#include "splitfusion/lib/deformation/motion_history.h"
#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/report/run_paths.h"
#include "support/motion_frames.h"
#include "support/program.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using nlohmann::json;

constexpr char kPython[] = "/usr/bin/python3";  // Debian's, which has OpenCV.

bool HasPythonModules() {
  const std::string command =
      std::string(kPython) + " -c 'import numpy, scipy, cv2' 2>/dev/null";
  return std::system(command.c_str()) == 0;
}

/// From this frame on the person is led away from where the camera sees it.
constexpr int kLedAway = 7;

/// Moves a surface aside in the motions and warped meshes of later frames.
void LeadAway(const std::string& folder) {
  RecordedSurface surface = ReadRecordedSurface(folder);
  EditFrames(
      [](FrameMotions& frame) {
        if (frame.frame < kLedAway) return;
        for (NodeMotion& motion : frame.motions) motion.translation.x() += 0.5;
      },
      &surface.motions);
  WriteMotions(folder + "/motions.bin", surface.motions, surface.graph.size());
  // It is no longer the run that its marker describes.
  std::filesystem::remove(std::filesystem::path(folder) / "../../run.json");
  const AnimatedSurface animated(surface);
  for (const FrameMotions& frame : surface.motions) {
    WritePly(folder + "/warped/" + RunPaths::FrameName(frame.frame) + ".ply",
             animated.MeshAt(frame.frame));
  }
}

/// A run of a small synthetic sequence whose person is lost in its last third.
class ReferenceScripts : public ::testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_SHARED_DATA(scripts_, "eval");
    if (!HasPythonModules()) {
      GTEST_SKIP() << "python3-numpy, -scipy, -opencv not found: install "
                      "Debian's packages";
    }
    for (const char* name : {"sf_synth", "sf_run", "sf_evaluate"}) {
      if (!HasProgram(name)) GTEST_SKIP() << name << " is not built";
    }
    Run("sf_synth",
        "--width=448 --height=336 --frames=10 --mesh_every=2 "
        "--subject_speed=2 --output=" +
            sequence_);
    Run("sf_run", "--warped_every=1 --pictures_every=0 --sequence=" +
                      sequence_ + " --output=" + run_);
    LeadAway(run_ + "/surfaces/001_person");
    const std::string flags =
        " --samples=5000 --run=" + run_ + " --ground_truth=" + sequence_;
    Run("sf_evaluate", flags);
    evaluation_ = json::parse(folder_.Read("run/evaluation.json"));
  }

  static void Run(const std::string& program, const std::string& arguments) {
    const ProgramResult result = RunProgram(program, arguments);
    ASSERT_EQ(result.exit_code, 0) << program << ": " << result.errors;
  }

  /// What a script prints; null if it fails.
  json Script(const std::string& arguments) const {
    const std::string output = folder_ / "script.json";
    const std::string command = std::string(kPython) + " " + scripts_ + "/" +
                                arguments + " > " + output;
    if (std::system(command.c_str()) != 0) return {};
    return json::parse(folder_.Read("script.json"));
  }

  const json& Instance(const std::string& name) const {
    for (const json& item : evaluation_["instances"]) {
      if (item["name"] == name) return item;
    }
    throw std::runtime_error("no instance " + name);
  }

  TemporaryFolder folder_;
  std::string scripts_ = SharedEntry("eval");
  std::string sequence_ = folder_ / "sequence";
  std::string run_ = folder_ / "run";
  json evaluation_;
};

TEST_F(ReferenceScripts, AgreeWithTheMeasuresOfInstances) {
  const json seen = Script("eval_seen.py " + run_ + " " + sequence_);
  ASSERT_FALSE(seen.empty());
  for (const auto& [name, expected] : seen.items()) {
    const json& found = Instance(name);
    if (expected["frames"] == 0) {  // Never in plain view.
      EXPECT_TRUE(found["seen"].is_null());
      continue;
    }
    EXPECT_NEAR(found["surface"]["f_score_seen"], expected["f_score_seen"],
                0.02);
    EXPECT_EQ(found["seen"]["surface_id"], expected["surface"]);
    EXPECT_EQ(found["seen"]["by_frame"].size(), expected["frames"]);
    EXPECT_NEAR(found["seen"]["precision"], expected["precision"], 0.02);
    EXPECT_NEAR(found["seen"]["recall"], expected["recall"], 0.02);
  }
  const json presence =
      Script("eval_people.py found " + run_ + " " + sequence_);
  ASSERT_TRUE(presence.contains("person1"));
  EXPECT_EQ(presence["person1"]["not_found"], 3);
  for (const auto& [name, expected] : presence.items()) {
    const json& found = Instance(name)["presence"];
    EXPECT_GT(expected["frames"], 0);
    EXPECT_EQ(found["surface_id"], expected["surface"]);
    EXPECT_EQ(found["frames_in_view"], expected["frames"]);
    EXPECT_EQ(found["frames_missing"], expected["not_found"]);
  }
}

TEST_F(ReferenceScripts, AgreeWithTheShapesAndGhosts) {
  const json ghost = Script("eval_people.py ghost " + run_ + " " + sequence_);
  EXPECT_NEAR(evaluation_["background"]["ghosts"], ghost["share"], 0.005);
  const json edges = Script("eval_people.py edges " + run_);
  for (const json& surface : evaluation_["surfaces"]) {
    for (const auto& [folder, expected] : edges.items()) {
      if (std::stoi(folder) != surface["surface_id"]) continue;
      // The files are without what is stretched, ours tells what was cut.
      EXPECT_EQ(expected["most_triangles_over_3cm"], 0);
      const double longest = 100 * surface["longest_edge"].get<double>();
      if (surface["stretched_triangles"] == 0) {
        EXPECT_NEAR(longest, expected["max_edge_cm"], 0.01);
      } else {
        EXPECT_GT(longest, 3);
        EXPECT_LT(expected["max_edge_cm"], 3);
      }
    }
  }
}

}  // namespace
}  // namespace splitfusion
