#include "splitfusion/lib/report/disk_space.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

TEST(EstimatedBytes, GrowsWithImagesFramesAndPictures) {
  const RunExtent small = {640 * 480, 100, 0};
  EXPECT_GT(EstimatedBytes(small), 50u << 20);
  EXPECT_LT(EstimatedBytes(small), 500u << 20);
  EXPECT_GT(EstimatedBytes({640 * 480, 1000, 0}), EstimatedBytes(small));
  EXPECT_GT(EstimatedBytes({1280 * 960, 100, 0}), EstimatedBytes(small));
  EXPECT_GT(EstimatedBytes({640 * 480, 100, 10}), EstimatedBytes(small));
  EXPECT_LT(EstimatedBytes({640 * 480, 100, 0, false}), EstimatedBytes(small));
}

TEST(CheckDiskSpace, SaysWhatIsLeftAndWhatIsNeeded) {
  const TemporaryFolder folder;
  CheckDiskSpace(folder / "", 1);
  ExpectInputError(
      [&] {
        CheckDiskSpace(folder / "", std::numeric_limits<std::int64_t>::max());
      },
      "left: expected");
}

}  // namespace
}  // namespace splitfusion
