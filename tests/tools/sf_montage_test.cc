// The program sf_montage, as others call it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "splitfusion/lib/report/montage.h"
#include "support/program.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;

TEST(SfMontage, PutsScaledPicturesSideBySide) {
  if (!HasProgram("sf_montage")) GTEST_SKIP() << "sf_montage is not built";
  const TemporaryFolder folder;
  const cv::Scalar red(0, 0, 255), blue(255, 0, 0);
  cv::imwrite(folder / "a.png", cv::Mat(40, 80, CV_8UC3, red));
  cv::imwrite(folder / "b.png", cv::Mat(40, 80, CV_8UC3, blue));
  const auto result = RunProgram(
      "sf_montage", "--tile_width=40 --columns=2 --pictures=first:" +
                        (folder / "a.png") + ",second:" + (folder / "b.png") +
                        " --output=" + (folder / "sheet.png"));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const cv::Mat sheet = cv::imread(folder / "sheet.png");
  ASSERT_EQ(sheet.rows, 20 + kCaptionHeight);
  EXPECT_EQ(sheet.at<cv::Vec3b>(sheet.rows - 1, 0), cv::Vec3b(0, 0, 255));
  EXPECT_EQ(sheet.at<cv::Vec3b>(sheet.rows - 1, sheet.cols - 1),
            cv::Vec3b(255, 0, 0));
}

TEST(SfMontage, SaysWhatIsWrong) {
  if (!HasProgram("sf_montage")) GTEST_SKIP() << "sf_montage is not built";
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& arguments) {
    const ProgramResult result = RunProgram("sf_montage", arguments);
    EXPECT_EQ(result.exit_code, 2);
    return result.errors;
  };
  EXPECT_THAT(refused("--pictures=nothing --output=a.jpg"),
              HasSubstr("CAPTION:FILE"));
  EXPECT_THAT(refused("--pictures=a:" + (folder / "no.png")),
              HasSubstr("no.png: expected a picture"));
  cv::imwrite(folder / "a.png", cv::Mat(4, 8, CV_8UC3, cv::Scalar::all(0)));
  EXPECT_THAT(refused("--output=a.txt --pictures=a:" + (folder / "a.png")),
              HasSubstr("a name ending in .jpg or .png"));
}

}  // namespace
}  // namespace splitfusion
