#include "splitfusion/lib/base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "support/expect_input_error.h"
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

TEST(WriteFileAtomically, ReplacesRegularFilesAlone) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& path) {
    WriteFileAtomically(path, [](std::ostream& out) { out << "new"; });
  };
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  ExpectInputError([&] { write(pipe); }, "pipe: cannot be written");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  // A link stays, and what it names is replaced.
  folder.Write("file", "old");
  std::filesystem::create_symlink("file", folder / "link");
  write(folder / "link");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(folder.Read("file"), "new");
}

}  // namespace
}  // namespace splitfusion
