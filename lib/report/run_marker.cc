#include "splitfusion/lib/report/run_marker.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "splitfusion/lib/base/brief_json.h"
#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr char kTool[] = "sf_run";

/// By RunStatus.
constexpr std::array<const char*, 4> kStatusNames = {"running", "complete",
                                                     "incomplete", "failed"};

RunStatus ParseStatus(const std::string& text) {
  const auto found = std::find(kStatusNames.begin(), kStatusNames.end(), text);
  if (found == kStatusNames.end()) {
    throw InputError("status '" + text + "': expected running, complete, " +
                     "incomplete or failed");
  }
  return static_cast<RunStatus>(found - kStatusNames.begin());
}

Json ToJson(const RunMarker& marker) {
  Json files = Json::array();
  for (const auto& [path, file] : marker.files) {
    files.push_back(
        {{"path", path}, {"bytes", file.bytes}, {"xxh3", file.xxh3}});
  }
  return {{"format_version", kFormatVersion},
          {"tool", kTool},
          {"id", marker.id},
          {"status", ToString(marker.status)},
          {"error", marker.error},
          {"resumed_at", marker.resumed_at},
          {"identity", marker.identity.Hash()},
          {"identity_parts", marker.identity.parts},
          {"defaults", marker.identity.defaults},
          {"outputs", marker.identity.outputs},
          {"phase", static_cast<int>(marker.phase)},
          {"files", files}};
}

/// A path that stays within the folder.
std::string CheckedPath(const std::string& path) {
  const fs::path parts(path);
  const bool leaves =
      path.empty() || parts.is_absolute() ||
      std::find(parts.begin(), parts.end(), "..") != parts.end();
  if (leaves) {
    throw InputError("path '" + path + "': expected one within the folder");
  }
  return path;
}

RunMarker FromJson(const Json& json) {
  if (json.at("tool") != kTool) {
    throw InputError("field 'tool': " + BriefJson(json.at("tool")) +
                     ": expected 'sf_run'");
  }
  RunMarker marker;
  marker.id = json.at("id").get<std::string>();
  marker.status = ParseStatus(json.at("status").get<std::string>());
  marker.error = json.at("error").get<std::string>();
  marker.resumed_at = json.at("resumed_at").get<std::vector<int>>();
  marker.identity.parts = json.at("identity_parts").get<NamedValues>();
  marker.identity.outputs = json.at("outputs").get<NamedValues>();
  marker.identity.defaults = json.value("defaults", NamedValues());
  const int phase = json.value("phase", 0);
  if (phase < 0 || phase > static_cast<int>(PublishingPhase::kMoving)) {
    throw InputError("phase " + std::to_string(phase) + ": expected 0..2");
  }
  marker.phase = static_cast<PublishingPhase>(phase);
  for (const Json& file : json.at("files")) {
    marker.files[CheckedPath(file.at("path").get<std::string>())] = {
        file.at("bytes").get<std::uint64_t>(),
        file.at("xxh3").get<std::string>()};
  }
  return marker;
}

RunFile Describe(const std::string& path) {
  return {fs::file_size(path), HashOfFile(path)};
}

}  // namespace

std::string ToString(RunStatus status) {
  return kStatusNames[static_cast<std::size_t>(status)];
}

OwnedFileList RunMarker::Owned() const {
  OwnedFileList owned;
  for (const auto& [path, file] : files) owned.push_back({path, file.bytes});
  return owned;
}

bool RunMarker::IsSame(const RunIdentity& other) const {
  return identity.parts == other.parts && identity.outputs == other.outputs;
}

std::optional<RunMarker> ReadRunMarker(const std::string& folder) {
  const std::string path = RunPaths(folder).Marker();
  if (!fs::exists(path)) return std::nullopt;
  const Json json = ReadVersionedOrNull(path);
  try {
    return FromJson(json);
  } catch (const Json::exception&) {
    throw InputError(path + ": is damaged: expected the marker of a run");
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
}

void WriteRunMarker(const std::string& folder, const RunMarker& marker) {
  WriteJson(RunPaths(folder).Marker(), ToJson(marker), 1);
}

std::map<std::string, RunFile> ListRunFiles(
    const std::string& folder, const std::vector<std::string>& left_out) {
  std::map<std::string, RunFile> files;
  const std::string marker =
      fs::path(RunPaths(folder).Marker()).filename().string();
  for (const OwnedFile& file : FilesBelow(folder)) {
    const bool out = file.path == marker ||
                     std::find(left_out.begin(), left_out.end(), file.path) !=
                         left_out.end();
    if (!out) {
      files[file.path] = Describe((fs::path(folder) / file.path).string());
    }
  }
  return files;
}

void CheckRunFile(const RunMarker& marker, const std::string& folder,
                  const std::string& path) {
  const auto found = marker.files.find(path);
  if (found == marker.files.end()) return;
  const std::string file = (fs::path(folder) / path).string();
  if (!fs::is_regular_file(file)) {
    throw InputError(file + ": is missing: expected a file of " +
                     std::to_string(found->second.bytes) + " bytes");
  }
  const RunFile now = Describe(file);
  if (now.bytes == found->second.bytes && now.xxh3 == found->second.xxh3) {
    return;
  }
  throw InputError(file + ": is not as the run wrote it (" +
                   std::to_string(now.bytes) + " bytes, hash " + now.xxh3 +
                   "): expected " + std::to_string(found->second.bytes) +
                   " bytes, hash " + found->second.xxh3);
}

std::string FindMissing(const RunMarker& marker, const std::string& folder) {
  const RunPaths paths(folder);
  for (const auto& [path, file] : marker.files) {
    const fs::path whole = fs::path(folder) / path;
    if (whole == paths.Evaluation()) continue;
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(whole, error);
    if (error) return path + " is missing";
    if (bytes != file.bytes) return path + " was changed";
  }
  return "";
}

void AddRunFile(const std::string& folder, const std::string& path) {
  std::optional<RunMarker> marker = ReadRunMarker(folder);
  if (!marker) return;
  marker->files[CheckedPath(path)] =
      Describe((fs::path(folder) / path).string());
  WriteRunMarker(folder, *marker);
}

}  // namespace splitfusion
