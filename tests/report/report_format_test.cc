// docs/report_format.md names every key and column that a run writes, and none
// that it does not write.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "splitfusion/lib/report/refinement_report.h"
#include "support/program.h"
#include "support/repository.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;
using Names = std::vector<std::string>;

/// Keys by where they stand, such as surfaces/rounds/solver/usable.
using Keys = std::set<std::string>;

/// Names in backticks, flags left out.
Names Quoted(const std::string& text) {
  static const std::regex name("`([a-z_]+)`");
  Names names;
  for (std::sregex_iterator i(text.begin(), text.end(), name), end; i != end;
       ++i) {
    names.push_back((*i)[1]);
  }
  return names;
}

Names Cells(const std::string& row) {
  Names cells;
  std::stringstream stream(row.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) {
    cells.push_back(cell);
  }
  return cells;
}

/// What one section of the page says of the keys of one file.
class Section {
 public:
  explicit Section(const std::string& title) {
    std::ifstream stream(RepositoryRoot() / "docs/report_format.md");
    bool inside = false, in_table = false;
    for (std::string line; std::getline(stream, line);) {
      if (line.rfind("## ", 0) == 0) inside = line == "## " + title;
      if (!inside) continue;
      if (line.empty() || line[0] != '|') {
        in_table = false;
        FindObject(line);
      } else if (line.rfind("| key |", 0) == 0 ||
                 line.rfind("| column |", 0) == 0) {
        in_table = true;
      } else if (in_table && line.rfind("|---", 0) != 0) {
        AddRow(Cells(line));
      }
    }
  }

  const Keys& keys() const { return keys_; }
  /// Keys of the first table, in its order.
  const Names& order() const { return order_; }

 private:
  /// "An entry of `rounds`:" or "The `solver` of a round:".
  void FindObject(const std::string& line) {
    static const std::regex head("^(An entry of|The) `([a-z_]+)`.*:$");
    std::smatch found;
    if (std::regex_match(line, found, head)) object_ = places_.at(found[2]);
  }

  void Add(const std::string& place) {
    keys_.insert(place);
    order_.push_back(place);
    places_[place.substr(place.rfind('/') + 1)] = place;
  }

  void AddRow(const Names& cells) {
    static const std::regex members("(object|array, one object)[^:]*: (.*)");
    const std::string& meaning = cells.back();
    for (const std::string& key : Quoted(cells.front())) {
      const std::string place = object_.empty() ? key : object_ + "/" + key;
      Add(place);
      std::smatch found;
      if (!std::regex_search(meaning, found, members)) continue;
      for (const auto& name : Quoted(found[2])) Add(place + "/" + name);
    }
  }

  std::string object_;  // That the next table is of.
  std::map<std::string, std::string> places_;
  Keys keys_;
  Names order_;
};

void CollectKeys(const Json& value, const std::string& place, Keys* keys) {
  if (value.is_array()) {
    for (const Json& entry : value) CollectKeys(entry, place, keys);
  } else if (value.is_object()) {
    for (const auto& item : value.items()) {
      const std::string key =
          place.empty() ? item.key() : place + "/" + item.key();
      keys->insert(key);
      CollectKeys(item.value(), key, keys);
    }
  }
}

/// A run of a few frames with everything in it that is reported.
class ReportFormat : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    if (!HasProgram("sf_synth") || !HasProgram("sf_run")) return;
    RunProgram("sf_synth", "--width=160 --height=120 --frames=4 --output=" +
                               (*folder_ / "sequence"));
    const ProgramResult run = RunProgram(
        "sf_run",
        "--covariance=1 --pictures_every=0 --warped_every=1 "
        "--set=terms.color.exposure=true --sequence=" +
            (*folder_ / "sequence") + " --output=" + (*folder_ / "run"));
    EXPECT_EQ(run.exit_code, 0) << run.errors;
  }
  static void TearDownTestSuite() { delete folder_; }

  void SetUp() override {
    if (!std::filesystem::exists(RepositoryRoot() / "docs/report_format.md")) {
      GTEST_SKIP() << "not built in the repository";
    }
    if (!folder_->Has("run/summary.json")) GTEST_SKIP() << "tools not built";
  }

  static Keys KeysOf(const std::string& file) {
    std::stringstream lines(folder_->Read("run/" + file));
    Keys keys;
    if (file == "summary.json") {
      CollectKeys(Json::parse(lines), "", &keys);
      return keys;
    }
    for (std::string line; std::getline(lines, line);) {
      CollectKeys(Json::parse(line), "", &keys);
    }
    return keys;
  }

  static TemporaryFolder* folder_;
};

TemporaryFolder* ReportFormat::folder_ = nullptr;

TEST_F(ReportFormat, HasTheKeysOfTheFrames) {
  const Section section("frames.jsonl");
  EXPECT_EQ(section.keys(), KeysOf("frames.jsonl"));
  EXPECT_EQ(section.keys().count("surfaces/rounds/solver/terms/final"), 1u);
}

TEST_F(ReportFormat, HasTheKeysOfTheSummary) {
  EXPECT_EQ(Section("summary.json").keys(), KeysOf("summary.json"));
}

TEST_F(ReportFormat, HasTheKeysOfTheRefinement) {
  Keys keys;
  RefinementReport report;
  report.Add(1, {RefinedWindow()}, {});
  CollectKeys(Json::parse(report.windows), "", &keys);
  EXPECT_EQ(Section("refinement.jsonl").keys(), keys);
}

TEST_F(ReportFormat, HasTheColumnsOfTheIterationsInTheirOrder) {
  std::stringstream lines(folder_->Read("run/iterations.csv"));
  std::string header;
  std::getline(lines, header);
  std::replace(header.begin(), header.end(), ',', '|');
  EXPECT_EQ(Section("iterations.csv").order(), Cells("|" + header));
}

}  // namespace
}  // namespace splitfusion
