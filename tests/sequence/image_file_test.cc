#include "splitfusion/lib/sequence/image_file.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/base/error.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

TEST(WriteImage, NamesThePathItCannotWrite) {
  const TemporaryFolder folder;
  const std::string file = folder.Write("file", "");
  try {
    WriteImage(file + "/picture.png", cv::Mat(2, 2, CV_8UC3));
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("file/picture.png"),
              std::string::npos);
  }
  EXPECT_THROW(WriteImage(folder / "empty.png", cv::Mat()), InputError);
  EXPECT_FALSE(folder.Has("empty.png"));
}

TEST(ReadDepthImage, NamesADamagedPngWithoutALineOfTheDecoder) {
  const TemporaryFolder folder;
  cv::Mat depth(48, 64, CV_16UC1);
  cv::RNG(1).fill(depth, cv::RNG::UNIFORM, 0, 10000);
  WriteImage(folder / "d.png", depth);
  const std::string whole = folder.Read("d.png");
  std::string bytes = whole;
  bytes[bytes.size() / 2] ^= 1;
  folder.Write("d.png", bytes);
  testing::internal::CaptureStderr();
  ExpectInputError([&] { ReadDepthImage(folder / "d.png"); },
                   " bytes of a png whose chunk IDAT is damaged: expected");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  folder.Write("d.png", whole + "and more");
  EXPECT_EQ(cv::norm(ReadDepthImage(folder / "d.png"), depth, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace splitfusion
