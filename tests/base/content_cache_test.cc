#include "splitfusion/lib/base/content_cache.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "splitfusion/lib/base/content_hash.h"
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

/// Replaces a text in all files of a folder.
void ReplaceInAll(const std::string& folder, const std::string& before,
                  const std::string& now) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream stream(entry.path());
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    ASSERT_NE(text.find(before), std::string::npos);
    std::ofstream(entry.path())
        << text.replace(text.find(before), before.size(), now);
  }
}

TEST(ContentCache, ReadsAgainWhatChangedAndNothingElse) {
  const TemporaryFolder folder;
  const ContentCache cache(folder / "cache");
  const std::string root = folder / "data";
  MakeOld(folder.Write("data/a", "one"), 1000);
  const auto hash = [&] { return cache.HashOfFiles(root, {"a"}); };
  const std::string one = hash();
  EXPECT_FALSE(folder.Has("cache"));  // It may still be changing.
  std::this_thread::sleep_for(std::chrono::milliseconds(3100));
  EXPECT_EQ(hash(), one);
  const std::string content = HashOfFile(folder / "data/a");
  ReplaceInAll(folder / "cache", content, std::string(32, '0'));
  EXPECT_NE(hash(), one);  // The file is not looked at.
  ReplaceInAll(folder / "cache", "{", "{half");
  EXPECT_EQ(hash(), one);
  // The same size and the same time, but it was changed.
  std::ofstream(folder / "data/a") << "two";
  MakeOld(folder / "data/a", 1000);
  EXPECT_NE(hash(), one);
}

TEST(ContentCache, TrustsNoFileThatIsJustBeingWritten) {
  const TemporaryFolder folder;
  const ContentCache cache(folder / "cache");
  folder.Write("data/a", "one");
  const std::string one = cache.HashOfFiles(folder / "data", {"a"});
  folder.Write("data/a", "two");
  EXPECT_NE(cache.HashOfFiles(folder / "data", {"a"}), one);
}

TEST(ContentCache, NamesTheFileThatIsMissing) {
  const TemporaryFolder folder;
  ExpectInputError(
      [&] { ContentCache("").HashOfFiles(folder / "", {"missing"}); },
      "missing");
}

}  // namespace
}  // namespace splitfusion
