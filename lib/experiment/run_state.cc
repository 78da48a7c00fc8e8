#include "splitfusion/lib/experiment/run_state.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;
using Texts = std::map<std::string, std::string>;

/// Differences that are named before the rest is counted.
constexpr std::size_t kNamed = 4;
/// Longest value that is shown whole; hashes are cut.
constexpr std::size_t kShown = 40;

std::string TextAt(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>()
                                                   : "";
}

Texts TextsAt(const Json& json, const char* key) {
  Texts texts;
  const auto found = json.find(key);
  if (found == json.end() || !found->is_object()) return texts;
  for (const auto& item : found->items()) {
    const Json& value = item.value();
    texts[item.key()] =
        value.is_string() ? value.get<std::string>() : value.dump();
  }
  return texts;
}

std::string Shown(const Texts& texts, const std::string& key) {
  const auto found = texts.find(key);
  if (found == texts.end()) return "nothing";
  const std::string& value = found->second;
  if (value.empty()) return "''";
  return value.size() <= kShown ? value : value.substr(0, kShown) + "...";
}

void AppendDifferences(const Texts& before, const Texts& after,
                       std::vector<std::string>* differences) {
  std::set<std::string> keys;
  for (const auto& item : before) keys.insert(item.first);
  for (const auto& item : after) keys.insert(item.first);
  for (const std::string& key : keys) {
    const auto old_value = before.find(key), new_value = after.find(key);
    const bool same = old_value != before.end() && new_value != after.end() &&
                      old_value->second == new_value->second;
    if (same) continue;
    differences->push_back(key + " " + Shown(before, key) + " -> " +
                           Shown(after, key));
  }
}

}  // namespace

Json ReadJsonOrNull(const std::string& path) {
  std::ifstream stream(path);
  Json value = Json::parse(stream, nullptr, /*allow_exceptions=*/false);
  return value.is_discarded() ? Json() : value;
}

RunState ReadRunState(const std::string& run) {
  const std::filesystem::path path = std::filesystem::path(run) / "run.json";
  RunState state;
  std::error_code ignored;
  state.exists = std::filesystem::exists(path, ignored);
  if (!state.exists) return state;
  const Json json = ReadJsonOrNull(path.string());
  if (!json.is_object() || TextAt(json, "status").empty()) {
    state.status = "damaged";
    return state;
  }
  state.id = TextAt(json, "id");
  state.status = TextAt(json, "status");
  state.error = TextAt(json, "error");
  const auto resumed = json.find("resumed_at");
  state.resumed = resumed != json.end() && !resumed->empty();
  state.identity = IdentityFromJson(json);
  const auto files = json.find("files");
  if (files == json.end() || !files->is_array()) return state;
  for (const Json& file : *files) {
    if (!file.is_object() || !file.contains("bytes")) continue;
    if (!file["bytes"].is_number()) continue;
    state.bytes[TextAt(file, "path")] = file["bytes"].get<double>();
  }
  return state;
}

RunIdentityText IdentityFromJson(const Json& json) {
  RunIdentityText identity;
  if (!json.is_object()) return identity;
  identity.identity = TextAt(json, "identity");
  identity.parts = TextsAt(json, "identity_parts");
  identity.outputs = TextsAt(json, "outputs");
  return identity;
}

std::string Differences(const RunIdentityText& before,
                        const RunIdentityText& after) {
  std::vector<std::string> differences;
  AppendDifferences(before.parts, after.parts, &differences);
  AppendDifferences(before.outputs, after.outputs, &differences);
  if (differences.empty() && before.identity != after.identity) {
    return "identity " + before.identity + " -> " + after.identity;
  }
  std::string text;
  for (std::size_t i = 0; i < differences.size() && i < kNamed; ++i) {
    text += (i > 0 ? ", " : "") + differences[i];
  }
  if (differences.size() > kNamed) {
    text += ", and " + std::to_string(differences.size() - kNamed) + " more";
  }
  return text;
}

}  // namespace splitfusion
