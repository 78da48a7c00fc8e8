#include "splitfusion/lib/experiment/task_record.h"

#include <unistd.h>

#include <array>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/experiment/run_state.h"
#include "splitfusion/lib/report/report_json.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<TaskState, const char*>, 7> kStates = {{
    {TaskState::kWaiting, "waiting"},
    {TaskState::kStarted, "started"},
    {TaskState::kChecking, "checking"},
    {TaskState::kComplete, "complete"},
    {TaskState::kFailed, "failed"},
    {TaskState::kUnevaluated, "not evaluated"},
    {TaskState::kRecorded, "recorded"},
}};

TaskState StateFromText(const std::string& text) {
  for (const auto& [state, name] : kStates) {
    if (text == name) return state;
  }
  throw InputError("state = " + text + ": expected one that sf_batch writes");
}

std::string RecordPath(const std::string& folder) {
  return (std::filesystem::path(folder) / "task.json").string();
}

Json RecordJson(const TaskRecord& record) {
  Json json = ToJson(record.task);
  json["format_version"] = 1;
  json["state"] = ToString(record.state);
  json["attempts"] = record.attempts;
  json["exit_code"] = record.exit_code;
  json["last_lines"] = record.last_lines;
  json["reason"] = record.reason;
  json["run_id"] = record.run_id;
  json["evaluated_id"] = record.evaluated_id;
  json["evaluated_by"] = record.evaluated_by;
  json["wall_seconds"] = record.wall_seconds;
  json["cpu_seconds"] = record.cpu_seconds;
  json["peak_memory_bytes"] = record.peak_memory_bytes;
  json["host"] = record.host;
  json["started"] = record.started;
  json["ended"] = record.ended;
  json["identity"] = record.identity;
  json["figures"] = ToJson(record.figures);
  return json;
}

TaskRecord RecordFromJson(const Json& json) {
  TaskRecord record;
  record.task = TaskFromJson(json);
  record.state = StateFromText(json.at("state").get<std::string>());
  record.attempts = json.at("attempts").get<int>();
  record.exit_code = json.at("exit_code").get<int>();
  record.last_lines = json.at("last_lines").get<std::vector<std::string>>();
  record.reason = json.at("reason").get<std::string>();
  record.run_id = json.at("run_id").get<std::string>();
  record.evaluated_id = json.at("evaluated_id").get<std::string>();
  record.evaluated_by = json.at("evaluated_by").get<std::string>();
  record.wall_seconds = json.at("wall_seconds").get<double>();
  record.cpu_seconds = json.at("cpu_seconds").get<double>();
  record.peak_memory_bytes = json.at("peak_memory_bytes").get<std::int64_t>();
  record.host = json.at("host").get<std::string>();
  record.started = json.at("started").get<std::string>();
  record.ended = json.at("ended").get<std::string>();
  record.identity = json.at("identity").get<std::string>();
  record.figures = FiguresFromJson(json.at("figures"));
  return record;
}

}  // namespace

std::string ToString(TaskState state) {
  return kStates[static_cast<std::size_t>(state)].second;
}

std::string TaskRecord::Error() const {
  return last_lines.empty() ? "" : last_lines.back();
}

std::optional<TaskRecord> ReadTaskRecord(const std::string& folder) try {
  const Json json = ReadJsonOrNull(RecordPath(folder));
  if (!json.is_object()) return std::nullopt;
  return RecordFromJson(json);
} catch (const InputError&) {
  return std::nullopt;
} catch (const nlohmann::json::exception&) {
  return std::nullopt;
}

void WriteTaskRecord(const std::string& folder, const TaskRecord& record) {
  WriteFileAtomically(RecordPath(folder), [&](std::ostream& out) {
    out << JsonText(RecordJson(record), 2) << '\n';
  });
}

std::string TimeText() {
  const std::time_t now = std::time(nullptr);
  std::tm parts = {};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

std::string HostName() {
  char name[256] = "";
  gethostname(name, sizeof(name) - 1);
  return name;
}

}  // namespace splitfusion
