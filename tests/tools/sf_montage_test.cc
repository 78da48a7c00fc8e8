// The program sf_montage, as others call it.

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "splitfusion/lib/report/montage.h"
#include "support/expect_refused.h"
#include "support/program.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

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
  ExpectRefused("sf_montage", "", "--pictures = '': expected CAPTION:FILE");
  ExpectRefused("sf_montage", "--pictures=nothing --output=a.jpg",
                "--pictures = nothing: expected CAPTION:FILE");
  ExpectRefused("sf_montage", "--pictures=a:" + (folder / "no.png"),
                "no.png: not found; expected a picture");
  ExpectRefused("sf_montage", "--pictures=a:" + folder.Write("b.png", "text"),
                "b.png: expected a picture");
  cv::imwrite(folder / "a.png", cv::Mat(4, 8, CV_8UC3, cv::Scalar::all(0)));
  const std::string picture = "--pictures=a:" + (folder / "a.png");
  ExpectRefused("sf_montage", "--output=a.txt " + picture,
                "a name ending in .jpg or .png");
  ExpectRefused("sf_montage", "--columns=0 " + picture,
                "--columns = 0: expected at least 1");
}

}  // namespace
}  // namespace splitfusion
