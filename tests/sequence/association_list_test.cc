#include "splitfusion/lib/sequence/association_list.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

TEST(ReadAssociations, TakesTheColumnsInEitherOrder) {
  const TemporaryFolder folder;
  for (const char* line :
       {"1.5 rgb/a.png 1.6 depth/b.png\n", "1.6 depth/b.png 1.5 rgb/a.png\n"}) {
    folder.Write("associations.txt", std::string("# both\n\n") + line);
    const std::vector<AssociatedFiles> pairs = ReadAssociations(folder / "");
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_EQ(pairs[0].color.file, "rgb/a.png");
    EXPECT_DOUBLE_EQ(pairs[0].color.timestamp, 1.5);
    EXPECT_EQ(pairs[0].depth.file, "depth/b.png");
    EXPECT_DOUBLE_EQ(pairs[0].depth.timestamp, 1.6);
  }
}

TEST(ReadAssociations, LooksIntoTheImagesIfNamesDoNotTell) {
  const TemporaryFolder folder;
  cv::imwrite(folder / "a.png", cv::Mat(4, 4, CV_16UC1, cv::Scalar(1000)));
  cv::imwrite(folder / "b.png", cv::Mat(4, 4, CV_8UC3, cv::Scalar::all(9)));
  folder.Write("associations.txt", "1 a.png 2 b.png\n");
  const std::vector<AssociatedFiles> pairs = ReadAssociations(folder / "");
  EXPECT_EQ(pairs[0].depth.file, "a.png");
  EXPECT_EQ(pairs[0].color.file, "b.png");
}

TEST(AssociateByTime, TakesTheNearestOnceEach) {
  const std::vector<TimedFile> color = {
      {1.000, "c0"}, {1.033, "c1"}, {1.066, "c2"}};
  // Both depth images are nearest to c1; the closer one gets it.
  const std::vector<TimedFile> depth = {
      {1.030, "d0"}, {1.040, "d1"}, {1.200, "d2"}};
  const std::vector<AssociatedFiles> pairs =
      AssociateByTime(color, depth, /*tolerance=*/0.03);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].depth.file, "d0");
  EXPECT_EQ(pairs[0].color.file, "c1");
  EXPECT_EQ(pairs[1].depth.file, "d1");
  EXPECT_EQ(pairs[1].color.file, "c2");
}

TEST(AssociateByTime, KeepsToTheTolerance) {
  const std::vector<TimedFile> color = {{1.0, "c"}};
  const std::vector<TimedFile> depth = {{1.021, "d"}};
  EXPECT_TRUE(AssociateByTime(color, depth, 0.02).empty());
  EXPECT_EQ(AssociateByTime(color, depth, 0.022).size(), 1u);
}

TEST(FindAssociations, UsesTheListsWithoutAssociationFile) {
  const TemporaryFolder folder;
  folder.Write("rgb.txt", "# t file\n2.0 rgb/2.png\n1.0 rgb/1.png\n");
  folder.Write("depth.txt", "1.01 depth/1.png\n2.01 depth/2.png\n");
  const std::vector<AssociatedFiles> pairs =
      FindAssociations(folder / "", 0.02);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].color.file, "rgb/1.png");
  EXPECT_EQ(pairs[1].color.file, "rgb/2.png");
}

TEST(FindAssociations, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  const auto find = [&] { FindAssociations(folder / "", 0.02); };
  ExpectInputError([&] { FindAssociations(folder / "none", 0.02); },
                   "no such folder");
  ExpectInputError(find, "rgb.txt: cannot be opened");
  folder.Write("rgb.txt", "1.0 rgb/1.png\n");
  folder.Write("depth.txt", "1.5 depth/1.png\n");
  ExpectInputError(find, "0 frames");
  folder.Write("associations.txt", "1.0 rgb/1.png 1.0\n");
  ExpectInputError(find, "associations.txt:1: '1.0 rgb/1.png 1.0'");
  folder.Write("associations.txt", "# empty\n");
  ExpectInputError(find, "0 frames");
}

}  // namespace
}  // namespace splitfusion
