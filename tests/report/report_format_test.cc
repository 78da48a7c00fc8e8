// docs/report_format.md names every key and column that the reports write.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "splitfusion/lib/report/iterations_csv.h"
#include "splitfusion/lib/report/report_json.h"
#include "splitfusion/lib/report/run_summary.h"
#include "splitfusion/pipelines/batch_summary.h"
#include "support/sample_report.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The page, found above the test program, which lies in the build folder.
std::string ReadPage() {
  fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  while (folder != folder.root_path() &&
         !fs::exists(folder / "docs/report_format.md")) {
    folder = folder.parent_path();
  }
  std::ifstream stream(folder / "docs/report_format.md");
  return {std::istreambuf_iterator<char>(stream), {}};
}

void CollectKeys(const Json& value, std::set<std::string>* keys) {
  if (value.is_object()) {
    for (const auto& item : value.items()) keys->insert(item.key());
  }
  if (!value.is_structured()) return;
  for (const Json& child : value) CollectKeys(child, keys);
}

void ExpectKeysInPage(const Json& value) {
  const std::string page = ReadPage();
  ASSERT_FALSE(page.empty()) << "docs/report_format.md not found";
  std::set<std::string> keys;
  CollectKeys(value, &keys);
  EXPECT_GT(keys.size(), 5u);
  for (const std::string& key : keys) {
    EXPECT_NE(page.find("`" + key + "`"), std::string::npos) << key;
  }
}

TEST(ReportFormat, NamesTheKeysOfAFrame) {
  ExpectKeysInPage(ToJson(SampleReport(0)));
}

TEST(ReportFormat, NamesTheKeysOfTheSummary) {
  SummaryBuilder builder;
  builder.Add(SampleReport(0));
  ExpectKeysInPage(ToJson(builder.Build()));
}

TEST(ReportFormat, NamesTheKeysOfABatch) {
  ExpectKeysInPage(ToJson(std::vector<BatchResult>(1)));
}

TEST(ReportFormat, NamesTheColumnsOfTheIterations) {
  std::stringstream header;
  WriteIterationsHeader(header);
  Json columns;
  std::string line;
  std::getline(header, line);
  std::stringstream fields(line);
  for (std::string name; std::getline(fields, name, ',');) columns[name] = 0;
  ExpectKeysInPage(columns);
}

}  // namespace
}  // namespace splitfusion
