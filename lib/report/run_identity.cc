#include "splitfusion/lib/report/run_identity.h"

#include <algorithm>
#include <set>
#include <vector>

#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/method_hash.h"

namespace splitfusion {
namespace {

/// Names in a line; the rest is counted.
constexpr std::size_t kNamed = 3;

bool IsHash(const std::string& value) {
  return value.size() == 32 &&
         value.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::string Change(const std::string& name, const std::string& before,
                   const std::string& now) {
  if (IsHash(before) || IsHash(now)) return name + " changed";
  const auto shown = [](const std::string& value) {
    return value.empty() ? std::string("''") : value;
  };
  return name + " " + shown(before) + " -> " + shown(now);
}

std::string ValueOf(const NamedValues& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? "none" : found->second;
}

std::vector<std::string> Changes(const NamedValues& before,
                                 const NamedValues& now) {
  std::set<std::string> names;
  for (const auto& [name, value] : before) names.insert(name);
  for (const auto& [name, value] : now) names.insert(name);
  std::vector<std::string> changes;
  for (const std::string& name : names) {
    const std::string a = ValueOf(before, name);
    const std::string b = ValueOf(now, name);
    if (a != b) changes.push_back(Change(name, a, b));
  }
  return changes;
}

std::string Joined(const std::vector<std::string>& changes) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamed, changes.size()); ++i) {
    text += (i == 0 ? "" : ", ") + changes[i];
  }
  if (changes.size() > kNamed) {
    text += " and " + std::to_string(changes.size() - kNamed) + " more";
  }
  return text;
}

}  // namespace

std::string RunIdentity::Hash() const {
  ContentHash hash;
  for (const auto& [name, value] : parts) hash.Add(name).Add(value);
  return hash.Hex();
}

std::string Differences(const NamedValues& before, const NamedValues& now) {
  return Joined(Changes(before, now));
}

std::string Differences(const RunIdentity& before, const RunIdentity& now) {
  std::vector<std::string> changes = Changes(before.parts, now.parts);
  for (std::string& change : Changes(before.outputs, now.outputs)) {
    changes.push_back(std::move(change));
  }
  return Joined(changes);
}

std::string MethodHash() { return SPLITFUSION_METHOD_HASH; }

}  // namespace splitfusion
