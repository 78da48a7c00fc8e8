#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "sf_run_fixture.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Files of a run by their names in its folder.
std::set<std::string> Files(const fs::path& run) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(run)) {
    if (entry.is_regular_file()) {
      names.insert(fs::relative(entry.path(), run).string());
    }
  }
  return names;
}

/// A report without what differs from run to run: times and memory.
json WithoutTimes(const json& value) {
  if (!value.is_structured()) return value;
  json kept = value;
  for (auto it = kept.begin(); it != kept.end();) {
    const std::string key = kept.is_object() ? it.key() : "";
    if (key.find("seconds") != std::string::npos ||
        key.find("memory") != std::string::npos) {
      it = kept.erase(it);
    } else {
      *it = WithoutTimes(*it);
      ++it;
    }
  }
  return kept;
}

/// Rows of frames.jsonl or the whole of summary.json.
std::vector<json> Reports(const std::string& text, bool by_line) {
  if (!by_line) return {WithoutTimes(json::parse(text))};
  std::vector<json> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    rows.push_back(WithoutTimes(json::parse(line)));
  }
  return rows;
}

/// iterations.csv without its last column, the time.
std::string WithoutLastColumn(const std::string& text) {
  std::istringstream lines(text);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    kept += line.substr(0, line.rfind(',')) + '\n';
  }
  return kept;
}

openvdb::GridPtrVecPtr ReadGrids(const std::string& path) {
  openvdb::initialize();
  openvdb::io::File file(path);
  file.open();
  return file.getGrids();
}

/// Number of voxels that differ between two grids of one type; -1 if the types
/// do.
template <typename Grid>
int Differences(const openvdb::GridBase& a, const openvdb::GridBase& b) {
  const auto* first = dynamic_cast<const Grid*>(&a);
  const auto* second = dynamic_cast<const Grid*>(&b);
  if (first == nullptr || second == nullptr) return -1;
  int count = !first->tree().hasSameTopology(second->tree());
  const auto other = second->getConstAccessor();
  for (auto it = first->cbeginValueAll(); it; ++it) {
    count += *it != other.getValue(it.getCoord());
  }
  return count;
}

void ExpectSameGrids(const std::string& a, const std::string& b) {
  const auto first = ReadGrids(a), second = ReadGrids(b);
  ASSERT_EQ(first->size(), second->size());
  EXPECT_GE(first->size(), 2u);
  for (std::size_t i = 0; i < first->size(); ++i) {
    const openvdb::GridBase& x = *(*first)[i];
    const openvdb::GridBase& y = *(*second)[i];
    EXPECT_EQ(x.getName(), y.getName());
    EXPECT_GT(x.activeVoxelCount(), 1000u) << x.getName();
    EXPECT_EQ(x.isType<openvdb::FloatGrid>()
                  ? Differences<openvdb::FloatGrid>(x, y)
                  : Differences<openvdb::Vec3SGrid>(x, y),
              0)
        << x.getName();
  }
}

class Determinism : public SfRun,
                    public ::testing::WithParamInterface<const char*> {
 protected:
  void RunWith(const std::string& output, int threads) {
    const ProgramResult result = Run(
        output, std::string("--solver=") + GetParam() +
                    " --pictures_every=0 --threads=" + std::to_string(threads));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }

  void ExpectSame(const std::string& a, const std::string& b) const {
    const std::set<std::string> files = Files(folder_ / a);
    ASSERT_EQ(files, Files(folder_ / b));
    EXPECT_EQ(files.count("surfaces/001_person/motions.bin"), 1u);
    for (const std::string& file : files) {
      // The flags hold the folder and the threads, the page holds times.
      // The marker holds an id and hashes of them.
      if (file == "options.flags" || file == "report.html" ||
          file == "run.json") {
        continue;
      }
      SCOPED_TRACE(file);
      const std::string one = a + "/" + file, two = b + "/" + file;
      const std::string kind = fs::path(file).extension();
      if (kind == ".vdb") {
        ExpectSameGrids(folder_ / one, folder_ / two);
      } else if (kind == ".json" || kind == ".jsonl") {
        EXPECT_EQ(Reports(folder_.Read(one), kind == ".jsonl"),
                  Reports(folder_.Read(two), kind == ".jsonl"));
      } else if (kind == ".csv") {
        EXPECT_EQ(WithoutLastColumn(folder_.Read(one)),
                  WithoutLastColumn(folder_.Read(two)));
      } else {
        EXPECT_TRUE(folder_.Read(one) == folder_.Read(two));
      }
    }
  }
};

TEST_P(Determinism, RunsAndThreadsGiveTheSameFiles) {
  Synthesize();
  RunWith("two", 2);
  RunWith("two_again", 2);
  RunWith("one", 1);
  ExpectSame("two", "two_again");
  ExpectSame("two", "one");
}

INSTANTIATE_TEST_SUITE_P(Solvers, Determinism,
                         ::testing::Values("gn_pcg", "gn_cholesky", "ceres"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace splitfusion
