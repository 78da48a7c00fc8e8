#include "splitfusion/lib/base/owned_files.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "splitfusion/lib/base/random_id.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

/// A folder `own` with three files of a program.
class OwnedFilesTest : public ::testing::Test {
 protected:
  OwnedFilesTest() {
    folder_.Write("own/list.txt", "four");
    folder_.Write("own/a/b/one.png", "1");
    folder_.Write("own/a/two.png", "22");
    files_ = FilesBelow(folder_ / "own");
  }
  std::vector<std::string> Remove() const {
    return RemoveOwnedFiles(folder_ / "own", files_);
  }

  TemporaryFolder folder_;
  OwnedFileList files_;
};

TEST_F(OwnedFilesTest, AreListedWithTheirSizes) {
  ASSERT_EQ(files_.size(), 3u);
  EXPECT_EQ(files_[0].path, "a/b/one.png");
  EXPECT_EQ(files_[1].path, "a/two.png");
  EXPECT_EQ(files_[2].path, "list.txt");
  EXPECT_EQ(files_[2].bytes, 4u);
  ExpectInputError([&] { FilesBelow(folder_ / "none"); }, "none: cannot be re");
}

TEST_F(OwnedFilesTest, AreRemovedWithTheirFolders) {
  EXPECT_EQ(ForeignFiles(folder_ / "own", files_), Names());
  EXPECT_EQ(Remove(), Names());
  EXPECT_TRUE(fs::is_empty(folder_ / "own"));
  EXPECT_EQ(Remove(), Names()) << "missing files are fine";
}

TEST_F(OwnedFilesTest, FilesOfOthersStay) {
  folder_.Write("own/a/b/notes.txt", "mine");
  fs::create_directories(folder_ / "own/empty");
  EXPECT_EQ(ForeignFiles(folder_ / "own", files_), Names({"a/b/notes.txt"}));
  EXPECT_EQ(Remove(), Names());
  EXPECT_EQ(folder_.Read("own/a/b/notes.txt"), "mine");
  EXPECT_TRUE(folder_.Has("own/empty"));
  EXPECT_FALSE(folder_.Has("own/a/two.png"));
}

TEST_F(OwnedFilesTest, ChangedFilesStay) {
  folder_.Write("own/list.txt", "edited by hand");
  fs::remove(folder_ / "own/a/two.png");
  folder_.Write("elsewhere", "22");
  fs::create_symlink(folder_ / "elsewhere", folder_ / "own/a/two.png");
  EXPECT_EQ(ForeignFiles(folder_ / "own", files_),
            Names({"a/two.png", "list.txt"}));
  EXPECT_EQ(Remove(), Names({"a/two.png", "list.txt"}));
  EXPECT_EQ(folder_.Read("own/list.txt"), "edited by hand");
  EXPECT_EQ(folder_.Read("elsewhere"), "22");
}

TEST_F(OwnedFilesTest, LinksToFoldersAreNotFollowed) {
  fs::rename(folder_ / "own/a", folder_ / "moved");
  fs::create_directory_symlink(folder_ / "moved", folder_ / "own/a");
  EXPECT_EQ(ForeignFiles(folder_ / "own", files_), Names({"a"}));
  EXPECT_EQ(Remove(), Names({"a/b/one.png", "a/two.png"}));
  EXPECT_EQ(folder_.Read("moved/two.png"), "22");
  EXPECT_TRUE(folder_.Has("own/a"));
}

TEST_F(OwnedFilesTest, PathsThatLeadOutAreNever) {
  folder_.Write("victim", "four");
  for (const std::string& path :
       {std::string("../victim"), folder_ / "victim",
        std::string("a/../../victim"), std::string("./list.txt"),
        std::string("a//two.png/"), std::string()}) {
    files_ = {{path, 4}};
    EXPECT_FALSE(IsAsWritten(folder_ / "own", files_[0])) << path;
    Remove();
  }
  EXPECT_EQ(folder_.Read("victim"), "four");
  EXPECT_EQ(folder_.Read("own/list.txt"), "four");
}

TEST_F(OwnedFilesTest, AMarkerIsReadBack) {
  const std::string path = folder_ / "own/marker.json";
  EXPECT_FALSE(ReadOwnershipMarker(path));
  WriteOwnershipMarker(path, {"sf_test", RandomId(), files_});
  const auto marker = ReadOwnershipMarker(path);
  ASSERT_TRUE(marker);
  EXPECT_EQ(marker->program, "sf_test");
  EXPECT_EQ(marker->id.size(), 32u);
  EXPECT_EQ(marker->id.find_first_not_of("0123456789abcdef"),
            std::string::npos);
  ASSERT_EQ(marker->files.size(), 3u);
  EXPECT_EQ(marker->files[1].path, "a/two.png");
  EXPECT_EQ(marker->files[1].bytes, 2u);
}

TEST_F(OwnedFilesTest, ABrokenMarkerIsRefused) {
  const std::string path = folder_ / "marker.json";
  const auto refuses = [&](const std::string& text, const std::string& part) {
    folder_.Write("marker.json", text);
    ExpectInputError([&] { ReadOwnershipMarker(path); },
                     "marker.json: " + part);
  };
  const std::string head =
      R"({"format_version": 1, "program": "p", "id": "i", "files": )";
  for (const std::string& text :
       {std::string(), std::string("[]"), std::string("7"), head, head + "[7]}",
        head + R"([{"path": "x"}]})", std::string(100000, '[')}) {
    refuses(text, "expected a list of the files");
  }
  refuses(R"({"format_version": 2})", "field 'format_version': 2: expected");
  refuses(head + R"([{"path": "../x", "bytes": 1}]})", "names '../x'");
  refuses(head + R"([{"path": "/x", "bytes": 1}]})", "names '/x'");
}

TEST(RandomId, DiffersEveryTime) { EXPECT_NE(RandomId(), RandomId()); }

}  // namespace
}  // namespace splitfusion
