#include "splitfusion/lib/energy/surface_energies.h"

#include <cctype>
#include <cstring>
#include <utility>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

/// Stands between the class and the rest of a key, and at the begin of keys of
/// all surfaces.
constexpr char kPrefix[] = "terms.";

/// Where `terms.` begins in a key; npos: in none of the energy.
std::size_t FindPrefix(const std::string& key) {
  if (key.rfind(kPrefix, 0) == 0) return 0;
  const std::size_t dot = key.find(std::string(".") + kPrefix);
  return dot == std::string::npos ? dot : dot + 1;
}

}  // namespace

std::string ClassKey(const std::string& class_name) {
  std::string key = class_name;
  for (char& c : key) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return key;
}

bool IsTermKey(const std::string& key) {
  return FindPrefix(key) != std::string::npos;
}

SurfaceEnergies SurfaceEnergies::Parse(const std::string& text,
                                       const TermRegistry& registry) {
  std::vector<TermText> of_all;
  std::map<std::string, Changes> changes;
  for (const TermText& term : SplitTerms(text)) {
    if (term.of_class.empty()) {
      of_all.push_back(term);
      continue;
    }
    if (term.name.empty() || term.options.empty()) {
      throw InputError("--terms: '" + term.of_class + "." + term.name +
                       "': expected CLASS.NAME(KEY=VALUE,...)");
    }
    for (const auto& [key, value] : term.options) {
      changes[term.of_class][term.name + "." + key] = value;
    }
  }
  SurfaceEnergies energies(MakeEnergy(of_all, registry));
  energies.changes_ = std::move(changes);
  energies.MakeClasses(registry);
  return energies;
}

void SurfaceEnergies::MakeClasses(const TermRegistry& registry) {
  of_class_.clear();
  for (auto& [of_class, changes] : changes_) {
    // Copies of an energy share their terms; these are to differ.
    Energy energy = ParseEnergy(EnergyText(all_), registry);
    for (const auto& [key, value] : changes) {
      SetTermOption(key, value, registry, &energy);
    }
    const auto values = TermOptionValues(energy);
    for (auto& [key, value] : changes) value = values.at(key);  // "4" of "4.0"
    of_class_[of_class] = std::move(energy);
  }
}

const Energy& SurfaceEnergies::Of(const std::string& class_name) const {
  const auto found = of_class_.find(ClassKey(class_name));
  return found == of_class_.end() ? all_ : found->second;
}

std::vector<std::string> SurfaceEnergies::classes() const {
  std::vector<std::string> classes;
  for (const auto& entry : changes_) classes.push_back(entry.first);
  return classes;
}

void SurfaceEnergies::Set(const std::string& key, const std::string& value,
                          const TermRegistry& registry) {
  const std::size_t prefix = FindPrefix(key);
  if (prefix == std::string::npos || prefix == 1) {
    throw InputError(key + ": expected terms.NAME.KEY or CLASS.terms.NAME.KEY");
  }
  const std::string option = key.substr(prefix + std::strlen(kPrefix));
  if (prefix == 0) {
    SetTermOption(option, value, registry, &all_);
  } else {
    changes_[ClassKey(key.substr(0, prefix - 1))][option] = value;
  }
  MakeClasses(registry);
}

void SurfaceEnergies::Check() const {
  CheckEnergy(all_);
  for (const auto& [of_class, energy] : of_class_) {
    try {
      CheckEnergy(energy);
    } catch (const InputError& error) {
      throw InputError("of class " + of_class + ": " + error.what());
    }
  }
}

std::string SurfaceEnergies::Text() const {
  std::string text = EnergyText(all_);
  for (const auto& [of_class, changes] : changes_) {
    std::string open;  // Its options go on; keys of one term are neighbours.
    for (const auto& [option, value] : changes) {
      const std::size_t dot = option.find('.');
      const std::string name = option.substr(0, dot);
      text += name == open ? "," : (open.empty() ? " " : ") ") + of_class +
                                       "." + name + "(";
      text += option.substr(dot + 1) + "=" + value;
      open = name;
    }
    text += ")";
  }
  return text;
}

std::map<std::string, std::string> SurfaceEnergies::OptionValues() const {
  std::map<std::string, std::string> values;
  for (const auto& [key, value] : TermOptionValues(all_)) {
    values[kPrefix + key] = value;
  }
  for (const auto& [of_class, changes] : changes_) {
    for (const auto& [key, value] : changes) {
      values[of_class + "." + kPrefix + key] = value;
    }
  }
  return values;
}

}  // namespace splitfusion
