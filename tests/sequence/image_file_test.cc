#include "splitfusion/lib/sequence/image_file.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/base/error.h"
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

}  // namespace
}  // namespace splitfusion
