#include "splitfusion/pipelines/batch_plan.h"

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

void CheckFile(const std::string& path, const std::string& what) {
  if (!fs::is_regular_file(path)) {
    throw InputError(path + ": not found; expected " + what);
  }
}

std::string Trimmed(const std::string& line) {
  const std::string text = line.substr(0, line.find('#'));
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

void AppendFolder(const std::string& folder,
                  std::vector<std::string>* sequences) {
  if (!fs::is_directory(folder)) {
    throw InputError(folder + ": not found; expected a sequence folder");
  }
  sequences->push_back(folder);
}

void AppendList(const std::string& path, std::vector<std::string>* sequences) {
  std::ifstream stream(path);
  std::string line;
  while (std::getline(stream, line)) {
    const std::string folder = Trimmed(line);
    if (folder.empty()) continue;
    AppendFolder((fs::path(path).parent_path() / folder).string(), sequences);
  }
}

/// Last part of a folder's path, whatever the way it was written.
std::string FolderName(const std::string& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

void CheckUnique(const std::string& name, const std::string& path,
                 std::set<std::string>* names) {
  if (!names->insert(name).second) {
    throw InputError(path + ": the name '" + name +
                     "' occurs twice; expected "
                     "different names, since run directories carry them");
  }
}

bool HasGroundTruth(const fs::path& folder) {
  return fs::is_regular_file(folder / "groundtruth.txt");
}

std::string FindGroundTruth(const BatchOptions& options, const BatchRun& run) {
  if (options.ground_truth == "none") return "";
  const fs::path sequence(run.sequence_folder);
  std::vector<fs::path> candidates = {sequence / "gt", sequence};
  if (options.ground_truth != "auto") {
    candidates = {fs::path(options.ground_truth) / run.sequence};
  }
  for (const fs::path& folder : candidates) {
    if (HasGroundTruth(folder)) return folder.string();
  }
  return "";
}

/// Names and paths of the option files; one without a path for the defaults.
std::vector<BatchRun> OptionColumns(const BatchOptions& options) {
  std::vector<BatchRun> columns;
  std::set<std::string> names;
  for (const std::string& path : options.option_files) {
    BatchRun column;
    column.options = fs::path(path).stem().string();
    column.option_file = path;
    CheckUnique(column.options, path, &names);
    columns.push_back(column);
  }
  if (columns.empty()) {
    columns.emplace_back();
    columns.back().options = "default";
  }
  return columns;
}

}  // namespace

void BatchOptions::Check() const {
  CheckOption(jobs >= 1 && jobs <= 1024, "jobs", jobs, "1..1024");
  CheckOption(!output.empty(), "output", "''", "a folder");
  CheckOption(!sequences.empty(), "sequences", "''", "at least one folder");
  CheckFile(run_program, "the program sf_run");
  for (const std::string& path : option_files) CheckFile(path, "a flagfile");
  if (ground_truth == "none") return;
  CheckFile(evaluate_program, "the program sf_evaluate");
  CheckOption(ground_truth == "auto" || fs::is_directory(ground_truth),
              "ground_truth", ground_truth, "auto, none or a folder");
}

std::vector<std::string> SplitAtCommas(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  std::string part;
  while (std::getline(stream, part, ',')) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

std::vector<std::string> ReadSequences(const std::string& text) {
  std::vector<std::string> sequences;
  for (const std::string& part : SplitAtCommas(text)) {
    if (fs::is_regular_file(part)) {
      AppendList(part, &sequences);
    } else {
      AppendFolder(part, &sequences);
    }
  }
  CheckOption(!sequences.empty(), "sequences", "'" + text + "'",
              "sequence folders or a list of them");
  return sequences;
}

std::vector<BatchRun> PlanBatch(const BatchOptions& options) {
  options.Check();
  const std::vector<BatchRun> columns = OptionColumns(options);
  std::vector<BatchRun> runs;
  std::set<std::string> names;
  for (const std::string& folder : options.sequences) {
    const std::string name = FolderName(folder);
    CheckUnique(name, folder, &names);
    for (BatchRun run : columns) {
      run.sequence = name;
      run.sequence_folder = folder;
      run.folder = (fs::path(options.output) / name / run.options).string();
      run.ground_truth = FindGroundTruth(options, run);
      runs.push_back(run);
    }
  }
  return runs;
}

}  // namespace splitfusion
