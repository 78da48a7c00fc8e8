#include "splitfusion/lib/base/content_cache.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// As if it had been written long ago.
void MakeOld(const std::string& path, int second) {
  const timespec times[2] = {{second, 0}, {second, 0}};
  ASSERT_EQ(utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
}

TEST(ContentCache, TellsNamesContentsAndOrderApart) {
  const TemporaryFolder folder;
  folder.Write("a", "1");
  folder.Write("b", "2");
  const ContentCache cache("");
  const std::string root = folder / "";
  const std::string hash = cache.HashOfFiles(root, {"a", "b"});
  EXPECT_EQ(cache.HashOfFiles(root, {"a", "b"}), hash);
  EXPECT_NE(cache.HashOfFiles(root, {"b", "a"}), hash);
  EXPECT_NE(cache.HashOfFiles(root, {"a"}), hash);
  folder.Write("b", "3");
  EXPECT_NE(cache.HashOfFiles(root, {"a", "b"}), hash);
}

TEST(ContentCache, ReadsAgainWhatChangedAndNothingElse) {
  const TemporaryFolder folder;
  const ContentCache cache(folder / "cache");
  const std::string root = folder / "data";
  MakeOld(folder.Write("data/a", "one"), 1000);
  const std::string one = cache.HashOfFiles(root, {"a"});
  // Same state, other content: it is not looked at.
  std::ofstream(folder / "data/a") << "two";
  MakeOld(folder / "data/a", 1000);
  EXPECT_EQ(cache.HashOfFiles(root, {"a"}), one);
  MakeOld(folder / "data/a", 1001);
  EXPECT_NE(cache.HashOfFiles(root, {"a"}), one);
}

TEST(ContentCache, TrustsNoFileThatIsJustBeingWritten) {
  const TemporaryFolder folder;
  const ContentCache cache(folder / "cache");
  folder.Write("data/a", "one");
  const std::string one = cache.HashOfFiles(folder / "data", {"a"});
  folder.Write("data/a", "two");
  EXPECT_NE(cache.HashOfFiles(folder / "data", {"a"}), one);
}

TEST(ContentCache, IsReadAnewWhereItIsDamaged) {
  const TemporaryFolder folder;
  const ContentCache cache(folder / "cache");
  MakeOld(folder.Write("data/a", "one"), 1000);
  const std::string one = cache.HashOfFiles(folder / "data", {"a"});
  for (const auto& entry :
       std::filesystem::directory_iterator(folder / "cache")) {
    std::ofstream(entry.path()) << "{half";
  }
  EXPECT_EQ(cache.HashOfFiles(folder / "data", {"a"}), one);
}

TEST(ContentCache, NamesTheFileThatIsMissing) {
  const TemporaryFolder folder;
  ExpectInputError(
      [&] { ContentCache("").HashOfFiles(folder / "", {"missing"}); },
      "missing");
}

}  // namespace
}  // namespace splitfusion
