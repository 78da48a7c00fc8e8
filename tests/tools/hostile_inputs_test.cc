// Inputs and machines that are not as they should be, as sf_run meets them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/repository.h"
#include "tools/sf_run_fixture.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

class HostileInputs : public SfRun {
 protected:
  /// Files of a folder of the sequence, by name.
  std::vector<fs::path> Files(const std::string& folder) const {
    std::vector<fs::path> files;
    for (const auto& entry :
         fs::directory_iterator(folder_ / ("sequence/" + folder))) {
      files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
  }
  /// Indices in frames.jsonl.
  std::vector<int> FramesOf(const std::string& run) const {
    std::istringstream lines(folder_.Read(run + "/frames.jsonl"));
    std::vector<int> frames;
    for (std::string line; std::getline(lines, line);) {
      frames.push_back(Json::parse(line).at("frame").get<int>());
    }
    return frames;
  }
};

TEST_F(HostileInputs, BadFramesAreLeftOutIfAskedFor) {
  Synthesize("--frames=5");
  fs::remove(Files("depth").at(1));
  fs::resize_file(Files("rgb").at(3), 100);
  EXPECT_EQ(Run("refused").exit_code, 2);
  EXPECT_FALSE(folder_.Has("refused/trajectory.txt"));
  const ProgramResult result = Run("run", "--skip_bad_frames");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(FramesOf("run"), (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(
      RunProgram("sf_evaluate",
                 "--samples=100 --track_frames=2 --run=" + (folder_ / "run") +
                     " --ground_truth=" + (folder_ / "sequence/gt"))
          .exit_code,
      0);
}

TEST_F(HostileInputs, AMaskOfAnotherSizeIsFoundBeforeTheFirstFrame) {
  Synthesize("--frames=3");
  const std::vector<fs::path> masks = Files("masks_noisy");
  const auto last = std::find_if(
      masks.rbegin(), masks.rend(),
      [](const fs::path& path) { return path.extension() == ".png"; });
  fs::resize_file(*last, 40);
  const ProgramResult result = Run("run");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr(last->string() + ": 40 bytes that are"));
  EXPECT_FALSE(folder_.Has("run/trajectory.txt"));
}

TEST_F(HostileInputs, APipeInPlaceOfATextIsRefused) {
  Synthesize("--frames=2");
  for (const char* name : {"associations.txt", "calibration.txt", "rgb.txt"}) {
    const std::string path = folder_ / (std::string("sequence/") + name);
    const std::string aside = folder_ / "aside";
    const bool has = fs::exists(path);
    if (has) fs::rename(path, aside);
    ASSERT_EQ(mkfifo(path.c_str(), 0644), 0);
    const std::string other = folder_ / "sequence/associations.txt";
    const bool hides = std::string(name) == "rgb.txt" && fs::exists(other);
    if (hides) fs::rename(other, folder_ / "other");
    const ProgramResult result = Run("run");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.errors, HasSubstr(path + ": is no regular file"));
    fs::remove(path);
    if (has) fs::rename(aside, path);
    if (hides) fs::rename(folder_ / "other", other);
  }
}

TEST_F(HostileInputs, LongClassNamesAreCutInTheNamesOfFolders) {
  Synthesize("--frames=2");
  const std::string name = std::string(300, 'p') + "/..";
  for (const fs::path& path : Files("masks_noisy")) {
    if (path.extension() != ".json") continue;
    const std::string file = fs::relative(path, folder_ / "").string();
    Json list = Json::parse(folder_.Read(file));
    for (Json& item : list) item["class"] = name;
    folder_.Write(file, list.dump());
  }
  const std::string labels =
      folder_.Write("labels.txt", name + ", non_rigid\n");
  const ProgramResult result =
      Run("run", "--pictures_every=0 --labels=" + labels);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(
      folder_.Has("run/surfaces/001_" + std::string(60, 'p') + "/mesh.ply"));
}

TEST_F(HostileInputs, ALackOfMemoryEndsInOrder) {
  Synthesize("--frames=2");
  const std::string program = (ProgramFolder() / "sf_run").string();
  // Returns as a shell does: 128 + signal.
  const auto run = [&](const std::string& limit, const std::string& arguments) {
    const int status =
        std::system(("bash -c 'ulimit -v " + limit + "; exec " + program + " " +
                     arguments + "' >/dev/null 2>" + (folder_ / "err"))
                        .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  };
  for (const char* limit : {"500000", "550000", "600000"}) {
    // Libraries that end the program before it begins.
    if (run(limit, "--help") != 0) continue;
    const int code = run(limit, "--overwrite --pictures_every=0 --sequence=" +
                                    (folder_ / "sequence") +
                                    " --output=" + (folder_ / "run"));
    EXPECT_LE(code, 2) << limit << ": " << folder_.Read("err");
  }
}

}  // namespace
}  // namespace splitfusion
