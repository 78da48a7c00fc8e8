#include "splitfusion/lib/base/atomic_file.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

TEST(CanMakeFiles, LeavesTheFolderAsItWas) {
  const TemporaryFolder folder;
  folder.Write("times.json.tmp", "mine");
  folder.Write(".probe", "mine, too");
  EXPECT_TRUE(CanMakeFiles(folder / "."));
  EXPECT_EQ(folder.Read("times.json.tmp"), "mine");
  EXPECT_EQ(folder.Read(".probe"), "mine, too");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "."), {}), 2);
}

TEST(CanMakeFiles, NotWhereNoFolderIs) {
  const TemporaryFolder folder;
  EXPECT_FALSE(CanMakeFiles(folder / "missing"));
  EXPECT_FALSE(CanMakeFiles(folder.Write("file", "")));
}

}  // namespace
}  // namespace splitfusion
