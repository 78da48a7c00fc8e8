#include "splitfusion/lib/experiment/task_list.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/experiment/design.h"

namespace splitfusion {

std::string WriteTaskList(const std::string& folder,
                          const std::vector<Task>& tasks) {
  std::string text;
  for (const Task& task : tasks) text += JsonText(ToJson(task)) + '\n';
  const std::string name = cv::format("tasks_%016lx.jsonl", StableHash(text));
  std::string path = (std::filesystem::path(folder) / name).string();
  if (std::filesystem::exists(path)) return path;
  WriteFileAtomically(path, [&](std::ostream& out) { out << text; });
  return path;
}

Task ReadTaskOfList(const std::string& path, int line) {
  std::ifstream stream(path);
  if (!stream) throw InputError(path + ": cannot be opened");
  std::string text;
  int lines = 0;
  while (lines < line && std::getline(stream, text)) ++lines;
  CheckOption(line >= 1, "task", line, "a line of " + path + ", from 1");
  CheckOption(lines == line, "task", line,
              "a line of " + path + ", which has " + std::to_string(lines));
  try {
    return TaskFromJson(nlohmann::ordered_json::parse(text));
  } catch (const nlohmann::json::exception&) {
    throw InputError(path + ":" + std::to_string(line) +
                     ": expected a task in JSON");
  } catch (const InputError& error) {
    throw InputError(path + ":" + std::to_string(line) + ": " + error.what());
  }
}

}  // namespace splitfusion
