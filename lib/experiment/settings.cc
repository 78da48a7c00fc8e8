#include "splitfusion/lib/experiment/settings.h"

#include <algorithm>
#include <set>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/text_file.h"

namespace splitfusion {
namespace {

std::string Quoted(const std::string& value) {
  const bool plain = value.find_first_of(",;\"") == std::string::npos &&
                     value == Trimmed(value);
  if (plain) return value;
  std::string text = "\"";
  for (const char c : value) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

/// KEY and what follows its '='.
Settings::Entry SplitEntry(const std::string& entry, const std::string& field) {
  const std::size_t equal = entry.find('=');
  const std::string key = Trimmed(entry.substr(0, equal));
  const bool is_key = equal != std::string::npos && !key.empty() &&
                      key.find_first_of(" \t\"-") == std::string::npos;
  CheckOption(is_key, field, "'" + entry + "'",
              "KEY=VALUE with a flag's name or [CLASS.]terms.NAME.KEY");
  return {key, Trimmed(entry.substr(equal + 1))};
}

/// Entries of "KEY=REST; KEY=REST".
std::vector<Settings::Entry> SplitEntries(const std::string& text,
                                          const std::string& field) {
  std::vector<Settings::Entry> entries;
  std::set<std::string> keys;
  for (const std::string& part : SplitOutsideQuotes(text, ';')) {
    entries.push_back(SplitEntry(part, field));
    const std::string& key = entries.back().first;
    CheckOption(keys.insert(key).second, field, "'" + part + "'",
                "every key once, " + key + " is there twice");
  }
  return entries;
}

}  // namespace

void Settings::Set(const std::string& key, const std::string& value) {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(),
                   [&](const Entry& entry) { return entry.first == key; });
  if (found != entries_.end()) {
    found->second = value;
  } else {
    entries_.emplace_back(key, value);
  }
}

void Settings::SetAll(const Settings& other) {
  for (const auto& [key, value] : other.entries()) Set(key, value);
}

const std::string* Settings::Find(const std::string& key) const {
  for (const Entry& entry : entries_) {
    if (entry.first == key) return &entry.second;
  }
  return nullptr;
}

namespace {

/// Parts between separators, empty ones too.
std::vector<std::string> SplitAll(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    if (c == separator && !quoted) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  for (std::string& part : parts) part = Trimmed(part);
  return parts;
}

}  // namespace

std::vector<std::string> SplitOutsideQuotes(const std::string& text,
                                            char separator) {
  std::vector<std::string> parts = SplitAll(text, separator);
  parts.erase(std::remove(parts.begin(), parts.end(), ""), parts.end());
  return parts;
}

std::string Unquoted(const std::string& text) {
  if (text.empty() || text.front() != '"') return text;
  std::string value;
  std::size_t i = 1;
  for (; i < text.size(); ++i) {
    if (text[i] == '"') {
      if (i + 1 == text.size() || text[i + 1] != '"') break;
      ++i;
    }
    value += text[i];
  }
  if (i + 1 != text.size()) {
    throw InputError(text + ": expected a value that ends with its quote");
  }
  return value;
}

Settings ParseSettings(const std::string& text, const std::string& field) {
  Settings settings;
  for (const auto& [key, value] : SplitEntries(text, field)) {
    const bool one = SplitOutsideQuotes(value, ',').size() < 2;
    CheckOption(one, field, "'" + key + "=" + value + "'",
                "one value; one with commas in double quotes");
    settings.Set(key, Unquoted(value));
  }
  return settings;
}

std::vector<Axis> ParseGrid(const std::string& text, const std::string& field) {
  std::vector<Axis> axes;
  for (const auto& [key, values] : SplitEntries(text, field)) {
    Axis axis{key, {}};
    for (const std::string& part : SplitAll(values, ',')) {
      CheckOption(!part.empty(), field, "'" + key + "=" + values + "'",
                  "values, separated by commas; an empty one as \"\"");
      axis.values.push_back(Unquoted(part));
    }
    axes.push_back(axis);
  }
  return axes;
}

std::string SettingsText(const Settings& settings) {
  std::string text;
  for (const auto& [key, value] : settings.entries()) {
    text += (text.empty() ? "" : "; ") + key + "=" + Quoted(value);
  }
  return text;
}

}  // namespace splitfusion
