#include "splitfusion/lib/experiment/task_record.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <opencv2/core.hpp>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

/// By TaskState.
constexpr std::array<const char*, 7> kStateNames = {
    "waiting", "started",       "checking", "complete",
    "failed",  "not evaluated", "recorded"};

TaskState StateFromText(const std::string& text) {
  const auto found = std::find(kStateNames.begin(), kStateNames.end(), text);
  CheckOption(found != kStateNames.end(), "state", text,
              "one that sf_batch writes");
  return static_cast<TaskState>(found - kStateNames.begin());
}

std::string RecordPath(const std::string& folder) {
  return (std::filesystem::path(folder) / "task.json").string();
}

/// null stands for what is unknown.
Json KnownNumber(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

double MeasuredNumber(const Json& value) {
  // Nothing takes no time: 0 stood for what had not been measured.
  const bool known = value.is_number() && value.get<double>() > 0;
  return known ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// An object of texts; none of what else it is.
NamedValues ValuesFromJson(const Json& json) {
  return json.is_object() ? json.get<NamedValues>() : NamedValues();
}

Json RecordJson(const TaskRecord& record) {
  Json json = ToJson(record.task);
  json["format_version"] = kFormatVersion;
  json["state"] = ToString(record.state);
  json["attempts"] = record.attempts;
  json["exit_code"] = record.exit_code;
  json["last_lines"] = record.last_lines;
  json["reason"] = record.reason;
  json["run_id"] = record.run_id;
  json["evaluated_id"] = record.evaluated_id;
  json["evaluated_by"] = record.evaluated_by;
  json["evaluation"] = record.evaluation;
  json["wall_seconds"] = KnownNumber(record.cost.wall_seconds);
  json["cpu_seconds"] = KnownNumber(record.cost.cpu_seconds);
  json["peak_memory_bytes"] = KnownNumber(record.cost.peak_memory_bytes);
  json["host"] = record.host;
  json["started"] = record.started;
  json["ended"] = record.ended;
  json["identity"] = record.identity;
  json["identity_parts"] = record.identity_parts;
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
  record.evaluated_by = ValuesFromJson(json.at("evaluated_by"));
  record.evaluation = json.value("evaluation", "");
  record.cost = {MeasuredNumber(json.at("wall_seconds")),
                 MeasuredNumber(json.at("cpu_seconds")),
                 MeasuredNumber(json.at("peak_memory_bytes"))};
  record.host = json.at("host").get<std::string>();
  record.started = json.at("started").get<std::string>();
  record.ended = json.at("ended").get<std::string>();
  record.identity = json.at("identity").get<std::string>();
  record.identity_parts = ValuesFromJson(json.value("identity_parts", Json()));
  record.figures = FiguresFromJson(json.at("figures"));
  return record;
}

}  // namespace

std::string ToString(TaskState state) {
  return kStateNames[static_cast<std::size_t>(state)];
}

std::string TaskRecord::Error() const {
  return last_lines.empty() ? "" : last_lines.back();
}

std::optional<TaskRecord> ReadTaskRecord(const std::string& folder) try {
  const Json json = ReadVersionedOrNull(RecordPath(folder));
  if (!json.is_object()) return std::nullopt;
  TaskRecord record = RecordFromJson(json);
  const bool own =
      record.task.name == std::filesystem::path(folder).filename().string();
  return own ? std::optional(std::move(record)) : std::nullopt;
} catch (const InputError&) {
  return std::nullopt;
} catch (const nlohmann::json::exception&) {
  return std::nullopt;
}

void WriteTaskRecord(const std::string& folder, const TaskRecord& record) {
  WriteJson(RecordPath(folder), RecordJson(record), 2);
}

std::string TimeText() {
  using std::chrono::milliseconds;
  const auto since_epoch =
      std::chrono::duration_cast<milliseconds>(
          std::chrono::system_clock::now().time_since_epoch())
          .count();
  const std::time_t seconds = since_epoch / 1000;
  std::tm parts = {};
  gmtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%S", &parts);
  return cv::format("%s.%03dZ", text, static_cast<int>(since_epoch % 1000));
}

}  // namespace splitfusion
