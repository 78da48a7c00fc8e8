// sf_segment, and sf_run with a network, as others call them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "support/expect_refused.h"
#include "support/program.h"
#include "support/temporary_folder.h"
#include "support/tiny_onnx.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class SfSegment : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"sf_synth", "sf_run", "sf_segment"}) {
      if (!HasProgram(program)) GTEST_SKIP() << program << " is not built";
    }
    SKIP_WITHOUT_TINY_ONNX();
    ASSERT_EQ(
        RunProgram("sf_synth", "--width=160 --height=120 --frames=3 --output=" +
                                   (folder_ / "sequence"))
            .exit_code,
        0);
    MakeTinyOnnx("yolov8seg", folder_ / "tiny.onnx");
    classes_ = folder_.Write("classes.txt", "person\nchair\n");
  }

  std::string NetworkFlags() const {
    return " --model=" + (folder_ / "tiny.onnx") +
           " --decoder=yolov8seg --class_names=" + classes_ + " ";
  }
  ProgramResult Run(const std::string& program, const std::string& output,
                    const std::string& flags) const {
    return RunProgram(program, "--sequence=" + (folder_ / "sequence") +
                                   " --output=" + (folder_ / output) + " " +
                                   flags);
  }
  void ExpectRefused(const std::string& program, const std::string& flags,
                     const std::string& text) const {
    splitfusion::ExpectRefused(program,
                               "--sequence=" + (folder_ / "sequence") +
                                   " --output=" + (folder_ / "refused") + " " +
                                   flags,
                               text);
    EXPECT_FALSE(folder_.Has("refused"));
  }
  /// Stems of the depth images.
  std::vector<std::string> Stems() const {
    std::vector<std::string> stems;
    for (const auto& entry :
         fs::directory_iterator(folder_ / "sequence/depth")) {
      stems.push_back(entry.path().stem().string());
    }
    std::sort(stems.begin(), stems.end());
    return stems;
  }

  TemporaryFolder folder_;
  std::string classes_;
};

TEST_F(SfSegment, WritesMasksAndOverlaysAndGoesOn) {
  const ProgramResult whole =
      Run("sf_segment", "masks",
          NetworkFlags() + "--overlays=" + (folder_ / "overlays"));
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  EXPECT_THAT(whole.output, HasSubstr("3 frames, 3 of them now, "));
  const std::vector<std::string> stems = Stems();
  ASSERT_EQ(stems.size(), 3u);
  for (const std::string& stem : stems) {
    EXPECT_TRUE(folder_.Has("masks/" + stem + ".png")) << stem;
    EXPECT_EQ(cv::imread(folder_ / ("overlays/" + stem + ".png")).size(),
              cv::Size(160, 120));
  }
  const std::string list = folder_.Read("masks/detections.jsonl");
  EXPECT_THAT(list, HasSubstr("\"class\":\"person\",\"score\":0.9,\"box\":["));

  fs::remove(folder_ / ("masks/" + stems[2] + ".png"));
  fs::remove(folder_ / ("overlays/" + stems[0] + ".png"));
  const ProgramResult again =
      Run("sf_segment", "masks",
          NetworkFlags() + "--overlays=" + (folder_ / "overlays"));
  EXPECT_THAT(again.output, HasSubstr("3 frames, 1 of them now, "));
  EXPECT_EQ(folder_.Read("masks/detections.jsonl"), list);
  EXPECT_TRUE(folder_.Has("overlays/" + stems[0] + ".png"));

  const ProgramResult other =
      Run("sf_segment", "masks", NetworkFlags() + "--score_threshold=0.7");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.errors,
              HasSubstr("another score_threshold (0.25, now 0.7"));
  EXPECT_THAT(other.errors, HasSubstr("another folder, or --overwrite\n"));
  EXPECT_EQ(Run("sf_segment", "masks",
                NetworkFlags() + "--score_threshold=0.7 --overwrite")
                .exit_code,
            0);
  EXPECT_THAT(folder_.Read("masks/detections.jsonl"),
              testing::Not(HasSubstr("0.6")));
}

TEST_F(SfSegment, ARunWithANetworkIsRepeatedFromItsMasks) {
  // The synthetic sequence has masks beside it; the network goes before them.
  const std::string flags = "--pictures_every=0 --warped_every=0 ";
  const ProgramResult inline_run =
      Run("sf_run", "run", flags + "--threads=1" + NetworkFlags());
  ASSERT_EQ(inline_run.exit_code, 0) << inline_run.errors;
  ASSERT_EQ(Run("sf_segment", "masks", NetworkFlags()).exit_code, 0);
  for (const std::string& stem : Stems()) {
    const std::string file = "/" + stem + ".png";
    EXPECT_FALSE(folder_.Read("masks" + file).empty());
    EXPECT_EQ(folder_.Read("run/detections" + file),
              folder_.Read("masks" + file));
  }
  EXPECT_THAT(folder_.Read("run/options.flags"),
              HasSubstr("--decoder=yolov8seg\n"));
  const ProgramResult repeated = Run(
      "sf_run", "repeated", flags + "--masks=" + (folder_ / "run/detections"));
  ASSERT_EQ(repeated.exit_code, 0) << repeated.errors;
  EXPECT_FALSE(folder_.Has("repeated/detections"));
  for (const char* file :
       {"/trajectory.txt", "/surfaces/000_background/mesh.ply"}) {
    EXPECT_EQ(folder_.Read(std::string("repeated") + file),
              folder_.Read(std::string("run") + file));
  }
  EXPECT_EQ(Run("sf_run", "run", flags + "--overwrite").exit_code, 0);
  EXPECT_FALSE(folder_.Has("run/detections"));
}

TEST_F(SfSegment, MasksOfARunAreOfImagesWithoutTheLens) {
  const std::string camera =
      "width 160\nheight 120\nfx 130\nfy 130\ncx 80\ncy 60\n"
      "depth_scale 5000\nk1 ";
  fs::remove(folder_ / "sequence/calibration.txt");
  folder_.Write("sequence/camera.txt", camera + "-0.4\n");
  const std::string flags =
      "--pictures_every=0 --warped_every=0 --rolling_shutter=0 ";
  ASSERT_EQ(Run("sf_run", "run", flags + NetworkFlags()).exit_code, 0);
  ASSERT_EQ(Run("sf_segment", "masks", NetworkFlags()).exit_code, 0);
  const auto masks = [&](const std::string& run) {
    std::string all;
    for (const std::string& stem : Stems()) {
      all += folder_.Read(run + "/masks/" + stem + ".png");
    }
    return all + folder_.Read(run + "/trajectory.txt");
  };
  const std::string of_run = flags + "--masks=" + (folder_ / "run/detections");
  const ProgramResult repeated = Run("sf_run", "repeated", of_run);
  ASSERT_EQ(repeated.exit_code, 0) << repeated.errors;
  EXPECT_EQ(masks("repeated"), masks("run"));
  // Those of sf_segment are of the files as they are.
  const std::string of_files = flags + "--masks=" + (folder_ / "masks");
  ASSERT_EQ(Run("sf_run", "of_files", of_files).exit_code, 0);
  folder_.Write("sequence/camera.txt", camera + "-0.3\n");
  ExpectRefused("sf_run", of_run,
                "run/detections: masks of images without the lens "
                "'-0.4 0 0 0 0 0 0 0': expected that of the sequence, '-0.3 ");
}

TEST_F(SfSegment, MasksOfAnotherSequenceAreNotGoneOnWith) {
  ASSERT_EQ(Run("sf_segment", "masks", NetworkFlags()).exit_code, 0);
  const std::string stem = Stems()[0];
  const std::string mask = folder_.Read("masks/" + stem + ".png");
  fs::copy(folder_ / "sequence", folder_ / "twin", fs::copy_options::recursive);
  const std::string other = "--sequence=" + (folder_ / "twin") +
                            " --output=" + (folder_ / "masks") + " " +
                            NetworkFlags();
  splitfusion::ExpectRefused("sf_segment", other, "another sequence (");
  EXPECT_EQ(folder_.Read("masks/" + stem + ".png"), mask);
  // A path written in another way is the same sequence.
  EXPECT_EQ(RunProgram("sf_segment",
                       "--sequence=" + (folder_ / "twin/../sequence") +
                           " --output=" + (folder_ / "masks") + NetworkFlags())
                .exit_code,
            0);
  EXPECT_EQ(RunProgram("sf_segment", other + "--overwrite").exit_code, 0);
}

TEST_F(SfSegment, BadUsageEndsWithTwoAndOneLine) {
  const std::string model = "--model=" + (folder_ / "tiny.onnx") + " ";
  ExpectRefused("sf_segment", "", "model = '': expected an ONNX file");
  ExpectRefused("sf_segment", model, "decoder = '': expected yolact or");
  ExpectRefused("sf_segment", model + "--decoder=yolo", "decoder = yolo");
  ExpectRefused("sf_segment", "--model=/no/such.onnx --decoder=yolact",
                "/no/such.onnx: cannot be opened");
  ExpectRefused("sf_segment", model + "--decoder=yolov8seg",
                "expected 1x86xN, a box, 80 classes");
  ExpectRefused("sf_segment", NetworkFlags() + "--network_size=640",
                "--network_size = 640: expected WxH");
  ExpectRefused("sf_segment", NetworkFlags() + "--top_k=0", "--top_k = 0");
  ExpectRefused("sf_segment", NetworkFlags() + "--first_frame=3",
                "--first_frame = 3: expected less than 3");
  ExpectRefused("sf_segment", NetworkFlags() + "--network_size=9999x9999",
                "--network_size = 9999x9999: expected WxH");
  ExpectRefused("sf_segment", NetworkFlags() + "--threads=2000",
                "--threads = 2000: expected 1..1024");
  ExpectRefused("sf_run", "--decoder=yolact", "--model = ''");
  ExpectRefused("sf_run", NetworkFlags() + "--masks=none",
                "--masks = none: expected auto with --model");
  ExpectRefused("sf_run", model + "--decoder=yolact", "no output 'loc'");
}

}  // namespace
}  // namespace splitfusion
