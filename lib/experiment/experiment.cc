#include "splitfusion/lib/experiment/experiment.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/format_version.h"
#include "splitfusion/lib/experiment/sequence_list.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

/// Flags of sf_run that the sweep itself sets.
constexpr std::array<const char*, 8> kOwnKeys = {
    "sequence", "output",         "overwrite", "keep_same",
    "set",      "print_identity", "help",      "row"};

/// The same of sf_evaluate.
constexpr std::array<const char*, 5> kOwnEvaluateKeys = {
    "run", "ground_truth", "output", "check_only", "help"};

template <std::size_t kSize>
void CheckKeys(const std::array<const char*, kSize>& own,
               const Settings& settings, const std::string& field) {
  for (const auto& [key, value] : settings.entries()) {
    CheckOption(std::find(own.begin(), own.end(), key) == own.end(), field, key,
                "another key: this one is set for every run");
  }
}

/// Text of a plain value.
std::string ValueText(const Json& value, const std::string& field) {
  if (value.is_string()) return value.get<std::string>();
  CheckOption(value.is_number() || value.is_boolean(), field, value.dump(),
              "a text, a number, true or false");
  return value.dump();
}

std::string TextAt(const Json& json, const char* key,
                   const std::string& field) {
  return json.contains(key) ? ValueText(json[key], field + "." + key) : "";
}

std::int64_t WholeAt(const Json& json, const char* key,
                     std::int64_t otherwise) {
  if (!json.contains(key)) return otherwise;
  CheckOption(json[key].is_number_integer(), key, json[key].dump(),
              "a whole number");
  return json[key].get<std::int64_t>();
}

Settings SettingsAt(const Json& json, const char* key) {
  return json.contains(key) ? SettingsFromJson(json[key], key) : Settings();
}

void CheckFields(const Json& json, const std::string& field,
                 const std::set<std::string>& known) {
  CheckOption(json.is_object(), field, json.dump().substr(0, 60), "an object");
  for (const auto& item : json.items()) {
    std::string names;
    for (const auto& name : known) names += " " + name;
    CheckOption(known.count(item.key()) == 1, field, "'" + item.key() + "'",
                "one of" + names);
  }
}

const Json& ListAt(const Json& json, const char* key) {
  static const Json kEmpty = Json::array();
  if (!json.contains(key)) return kEmpty;
  CheckOption(json[key].is_array(), key, json[key].dump().substr(0, 60),
              "a list");
  return json[key];
}

SequenceEntry SequenceFromJson(const Json& json, const std::string& truth,
                               const std::string& root) {
  if (json.is_string()) {
    return MakeSequence(json.get<std::string>(), truth, root);
  }
  CheckFields(json, "sequences", {"folder", "name", "set", "ground_truth"});
  CheckOption(json.contains("folder"), "sequences", json.dump(),
              "a 'folder' in every entry");
  std::string own_truth = truth;
  if (json.contains("ground_truth")) {
    own_truth = TextAt(json, "ground_truth", "sequences");
  }
  SequenceEntry entry =
      MakeSequence(TextAt(json, "folder", "sequences"), own_truth, root);
  if (json.contains("name")) entry.name = TextAt(json, "name", "sequences");
  entry.set = SettingsAt(json, "set");
  return entry;
}

std::vector<Axis> GridFromJson(const Json& json) {
  std::vector<Axis> axes;
  CheckOption(json.is_object(), "grid", json.dump().substr(0, 60),
              "an object of lists");
  for (const auto& item : json.items()) {
    Axis axis{item.key(), {}};
    const std::string field = "grid." + item.key();
    if (!item.value().is_array()) {
      axis.values.push_back(ValueText(item.value(), field));
    } else {
      for (const Json& value : item.value()) {
        axis.values.push_back(ValueText(value, field));
      }
    }
    axes.push_back(axis);
  }
  return axes;
}

std::vector<NamedSettings> RowsFromJson(const Json& json) {
  std::vector<NamedSettings> rows;
  for (const Json& item : json) {
    CheckFields(item, "rows", {"name", "set", "note"});
    CheckOption(item.contains("name"), "rows", item.dump(),
                "a 'name' in every row");
    rows.push_back({TextAt(item, "name", "rows"), SettingsAt(item, "set")});
  }
  return rows;
}

/// All but the sequences.
Experiment WithoutSequences(const Json& json) {
  CheckFields(json, "experiment",
              {"about", "sequences", "set", "grid", "random", "rows", "repeat",
               "baseline", "ground_truth", "evaluate", "format_version"});
  CheckFormatVersion("experiment", json);
  Experiment experiment;
  experiment.set = SettingsAt(json, "set");
  if (json.contains("grid")) experiment.grid = GridFromJson(json["grid"]);
  if (json.contains("random")) {
    CheckFields(json["random"], "random", {"count", "seed"});
    experiment.random = static_cast<int>(WholeAt(json["random"], "count", 0));
    experiment.seed =
        static_cast<std::uint64_t>(WholeAt(json["random"], "seed", 1));
  }
  experiment.rows = RowsFromJson(ListAt(json, "rows"));
  experiment.repeat = static_cast<int>(WholeAt(json, "repeat", 1));
  experiment.baseline = TextAt(json, "baseline", "experiment");
  experiment.evaluate = SettingsAt(json, "evaluate");
  return experiment;
}

void CheckNames(std::vector<std::string> names, const std::string& field) {
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  const std::string name = twice == names.end() ? "" : *twice;
  CheckOption(twice == names.end(), field, "'" + name + "'",
              "different names, since tables and folders carry them");
}

/// A number in a form that is the same for 4 and 4.0; other texts as they are.
std::string Plain(const std::string& value) {
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  return value.empty() || *end != '\0' ? value : Json(number).dump();
}

void CheckValues(const Axis& axis) {
  CheckOption(!axis.values.empty(), "grid", axis.key, "at least one value");
  std::set<std::string> known;
  for (const std::string& value : axis.values) {
    CheckOption(known.insert(Plain(value)).second, "grid",
                "'" + axis.key + "=" + value + "'",
                "every value once, this one is there twice");
  }
}

}  // namespace

double Experiment::Count() const {
  double points = random;
  if (random == 0) {
    points = 1;
    for (const Axis& axis : grid) {
      points *= static_cast<double>(axis.values.size());
    }
  }
  return points * repeat *
         static_cast<double>(sequences.size() *
                             std::max<std::size_t>(1, rows.size()));
}

void Experiment::Check() const {
  CheckOption(!sequences.empty(), "sequences", "''",
              "sequence folders or a list of them");
  CheckFieldsAlone();
  constexpr double kMost = 1e6;
  CheckOption(Count() <= kMost, "experiment", Count(), "at most 1000000 runs");
}

void Experiment::CheckFieldsAlone() const {
  CheckOption(repeat >= 1, "repeat", repeat, "at least 1");
  CheckOption(random >= 0, "random", random, "at least 0");
  std::vector<std::string> names;
  for (const SequenceEntry& entry : sequences) {
    CheckKeys(kOwnKeys, entry.set, "sequences.set");
    names.push_back(entry.name);
  }
  CheckNames(names, "sequences");
  names.clear();
  for (const NamedSettings& row : rows) {
    CheckKeys(kOwnKeys, row.set, "rows.set");
    names.push_back(row.name);
  }
  CheckNames(names, "rows");
  CheckKeys(kOwnKeys, set, "set");
  CheckKeys(kOwnEvaluateKeys, evaluate, "evaluate");
  Settings swept;
  for (const Axis& axis : grid) {
    CheckValues(axis);
    swept.Set(axis.key, "");
  }
  CheckKeys(kOwnKeys, swept, "grid");
}

Experiment ReadExperiment(const std::string& path) {
  std::ifstream stream(path);
  if (!stream || !std::filesystem::is_regular_file(path)) {
    throw InputError(path + ": cannot be read; expected an experiment file");
  }
  try {
    const Json json = Json::parse(stream, nullptr, /*allow_exceptions=*/true,
                                  /*ignore_comments=*/true);
    const std::filesystem::path absolute = std::filesystem::absolute(path);
    const Experiment experiment =
        ExperimentFromJson(json, absolute.parent_path().string());
    experiment.CheckFieldsAlone();
    return experiment;
  } catch (const Json::parse_error& error) {
    // What follows the bracket says line and column.
    const std::string text = error.what();
    throw InputError(path +
                     ": expected JSON: " + text.substr(text.find(']') + 2));
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
}

Experiment ExperimentFromJson(const Json& json, const std::string& folder) {
  Experiment experiment = WithoutSequences(json);
  std::string truth = TextAt(json, "ground_truth", "experiment");
  if (truth.empty()) truth = "auto";
  for (const Json& item : ListAt(json, "sequences")) {
    experiment.sequences.push_back(SequenceFromJson(item, truth, folder));
  }
  return experiment;
}

Experiment SavedExperiment(const Json& json) {
  Experiment experiment = WithoutSequences(json);
  for (const Json& item : ListAt(json, "sequences")) {
    CheckFields(item, "sequences", {"folder", "name", "set", "ground_truth"});
    const std::string truth = TextAt(item, "ground_truth", "sequences");
    experiment.sequences.push_back(
        {TextAt(item, "name", "sequences"), TextAt(item, "folder", "sequences"),
         truth == "none" ? "" : truth, SettingsAt(item, "set")});
  }
  return experiment;
}

Json ToJson(const Experiment& experiment) {
  Json sequences = Json::array(), grid = Json::object(), rows = Json::array();
  for (const SequenceEntry& entry : experiment.sequences) {
    sequences.push_back(
        {{"folder", entry.folder},
         {"name", entry.name},
         {"set", ToJson(entry.set)},
         {"ground_truth",
          entry.ground_truth.empty() ? "none" : entry.ground_truth}});
  }
  for (const Axis& axis : experiment.grid) grid[axis.key] = axis.values;
  for (const NamedSettings& row : experiment.rows) {
    rows.push_back({{"name", row.name}, {"set", ToJson(row.set)}});
  }
  return {{"sequences", sequences},
          {"set", ToJson(experiment.set)},
          {"grid", grid},
          {"random", {{"count", experiment.random}, {"seed", experiment.seed}}},
          {"rows", rows},
          {"repeat", experiment.repeat},
          {"baseline", experiment.baseline},
          {"evaluate", ToJson(experiment.evaluate)}};
}

Settings SettingsFromJson(const Json& json, const std::string& field) {
  CheckOption(json.is_object(), field, json.dump().substr(0, 60),
              "an object of keys and values");
  Settings settings;
  for (const auto& item : json.items()) {
    settings.Set(item.key(), ValueText(item.value(), field + "." + item.key()));
  }
  return settings;
}

Json ToJson(const Settings& settings) {
  Json json = Json::object();
  for (const auto& [key, value] : settings.entries()) json[key] = value;
  return json;
}

}  // namespace splitfusion
