// What sf_run says of input that it can go on with.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "tools/sf_run_fixture.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

class SfRunWarnings : public SfRun {
 protected:
  long LinesOf(const std::string& file) const {
    const std::string text = folder_.Read(file);
    return std::count(text.begin(), text.end(), '\n');
  }
};

TEST_F(SfRunWarnings, FramesWithoutDepthArePassedOverAndNamed) {
  Synthesize();
  std::vector<fs::path> images;
  for (const auto& entry : fs::directory_iterator(folder_ / "sequence/depth")) {
    images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  const auto blacken = [&](std::size_t i) {
    cv::imwrite(images[i].string(), cv::Mat::zeros(120, 160, CV_16UC1));
  };
  blacken(0);
  blacken(1);
  const std::string stem = images[0].stem().string();
  const ProgramResult late = Run("late", "--pictures_every=0");
  EXPECT_EQ(late.exit_code, 0);
  EXPECT_THAT(late.errors,
              HasSubstr("frame 0, " + stem +
                        ": no background to begin with: expected depth from "
                        "0.4 to 5 m (--min_depth, --max_depth, --depth_scale); "
                        "passed over until there is\n"));
  EXPECT_THAT(late.errors, Not(HasSubstr("frame 1, ")));
  EXPECT_TRUE(folder_.Has("late/surfaces/000_background/mesh.ply"));
  EXPECT_EQ(LinesOf("late/frames.jsonl"), 4);
  blacken(2);
  blacken(3);
  const ProgramResult dark = Run("dark", "--pictures_every=0");
  EXPECT_EQ(dark.exit_code, 2);
  EXPECT_THAT(dark.errors, HasSubstr("sequence: nothing to reconstruct in any "
                                     "of 4 frames: expected depth from 0.4"));
  EXPECT_EQ(LinesOf("dark/frames.jsonl"), 4);
  EXPECT_TRUE(folder_.Has("dark/summary.json"));
}

TEST_F(SfRunWarnings, WarnsWhereMasksAreMissing) {
  Synthesize();
  const std::string flags = "--max_frames=2 --pictures_every=0 ";
  fs::path left_out;
  for (const auto& entry :
       fs::directory_iterator(folder_ / "sequence/masks_noisy")) {
    const bool is_mask = entry.path().extension() == ".png";
    if (is_mask) left_out = std::max(left_out, entry.path());
  }
  fs::remove(left_out);
  const ProgramResult fewer = Run("fewer", "--pictures_every=0");
  EXPECT_EQ(fewer.exit_code, 0);
  EXPECT_THAT(fewer.errors,
              HasSubstr("sequence/masks_noisy: masks of 3 of 4 frames; in the "
                        "others nothing is detected\n"));
  const std::string none = "no masks found: neither ";
  EXPECT_THAT(Run("all", flags).errors, Not(HasSubstr("masks")));
  fs::remove_all(folder_ / "sequence/masks_noisy");
  fs::remove_all(folder_ / "sequence/mask");
  const ProgramResult auto_masks = Run("auto", flags);
  EXPECT_EQ(auto_masks.exit_code, 0);
  EXPECT_THAT(
      auto_masks.errors,
      testing::AllOf(HasSubstr(none), HasSubstr("sequence/mask; only the "
                                                "background is reconstructed; "
                                                "use --masks or --model\n")));
  for (const char* quiet : {"--masks=none", "--preset=kinectfusion"}) {
    const ProgramResult result = Run("auto", flags + "--overwrite " + quiet);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.errors, Not(HasSubstr(none))) << quiet;
  }
}

TEST_F(SfRunWarnings, WarnsOfClassesToMergeThatNothingKnows) {
  Synthesize();
  const std::string flags = "--max_frames=1 --pictures_every=0 --overwrite ";
  const std::string warning = "--merge_touching: no label table, ";
  const auto said = [&](const std::string& more) {
    const ProgramResult result = Run("run", flags + more);
    EXPECT_EQ(result.exit_code, 0);
    return result.errors;
  };
  EXPECT_THAT(said("--merge_touching='person+teddybear,cat+robot,dog+cat'"),
              HasSubstr(warning + "network or mask knows 'robot', "
                                  "'teddybear'\n"));
  const std::string labels = folder_.Write("labels.txt", "robot, rigid\n");
  EXPECT_THAT(said("--merge_touching=person+robot --labels=" + labels),
              Not(HasSubstr(warning)));
  for (const auto& entry :
       fs::directory_iterator(folder_ / "sequence/masks_noisy")) {
    if (entry.path().extension() != ".json") continue;
    folder_.Write("sequence/masks_noisy/" + entry.path().filename().string(),
                  R"([{"index": 1, "class": "robot"}])");
  }
  EXPECT_THAT(said("--merge_touching=person+robot"), Not(HasSubstr(warning)));
}

}  // namespace
}  // namespace splitfusion
