#include "splitfusion/lib/base/spool_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "splitfusion/lib/base/error.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// The folder of temporary files is another one meanwhile.
class SpoolFolder {
 public:
  explicit SpoolFolder(const std::string& path) {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    setenv("TMPDIR", path.c_str(), /*overwrite=*/1);
  }
  ~SpoolFolder() {
    if (before_.empty()) {
      unsetenv("TMPDIR");
    } else {
      setenv("TMPDIR", before_.c_str(), /*overwrite=*/1);
    }
  }

 private:
  std::string before_;
};

TEST(SpoolFile, ReadsWhatWasWritten) {
  SpoolFile file;
  EXPECT_EQ(file.Append("abcdef", 6), 0u);
  EXPECT_EQ(file.Append("ghi", 3), 6u);
  file.Write(2, "XY", 2);
  std::string read(7, '?');
  file.Read(1, read.data(), read.size());
  EXPECT_EQ(read, "bXYefgh");
}

TEST(SpoolFile, HasNoNameAndLeavesNothing) {
  const TemporaryFolder folder;
  const SpoolFolder here(folder / "");
  SpoolFile file;
  file.Append("abc", 3);
  EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

TEST(SpoolFile, SaysWhatIsWrong) {
  SpoolFile file;
  file.Append("abc", 3);
  char byte;
  EXPECT_THROW(file.Read(3, &byte, 1), InputError) << "behind the end";
  const TemporaryFolder folder;
  const std::string missing = folder / "missing";
  const SpoolFolder there(missing);
  ExpectInputError([] { SpoolFile().Append("abc", 3); },
                   "TMPDIR = '" + missing + "': expected a folder");
}

}  // namespace
}  // namespace splitfusion
