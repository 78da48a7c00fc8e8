#include "splitfusion/lib/energy/term_registry.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/number_text.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {
namespace {

double ParseNumber(const std::string& key, const std::string& value) {
  std::size_t used = 0;
  double number = std::nan("");
  try {
    number = std::stod(value, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  CheckOption(used == value.size() && std::isfinite(number), key, value,
              "a number");
  return number;
}

void SetKey(const std::string& key, const std::string& value,
            TermOptions* options) {
  const std::string field = options->name + "." + key;
  if (key == "weight") {
    options->weight = ParseNumber(field, value);
    CheckOption(options->weight >= 0, field, value, "a number >= 0");
  } else if (key == "scale") {
    options->scale = ParseNumber(field, value);
    CheckOption(options->scale > 0, field, value, "metres > 0");
  } else if (key == "loss") {
    options->loss = ParseLoss(value);
  } else {
    throw InputError("--terms: key '" + key + "' of term '" + options->name +
                     "': expected weight, loss or scale");
  }
}

std::string Trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t\n");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\n") - begin + 1);
}

void ParseArguments(const std::string& arguments, TermOptions* options) {
  std::size_t begin = 0;
  while (begin < arguments.size()) {
    const std::size_t end =
        std::min(arguments.find(',', begin), arguments.size());
    const std::string pair = Trimmed(arguments.substr(begin, end - begin));
    const std::size_t equals = pair.find('=');
    if (equals == std::string::npos) {
      throw InputError("--terms: '" + pair + "' in term '" + options->name +
                       "': expected key=value");
    }
    SetKey(Trimmed(pair.substr(0, equals)), Trimmed(pair.substr(equals + 1)),
           options);
    begin = end + 1;
  }
}

}  // namespace

Energy ParseEnergy(const std::string& text, const TermRegistry& registry) {
  Energy energy;
  std::size_t at = 0;
  while ((at = text.find_first_not_of(" \t\n", at)) != std::string::npos) {
    std::size_t end = at;
    while (end < text.size() &&
           (std::isalnum(static_cast<unsigned char>(text[end])) ||
            text[end] == '_')) {
      ++end;
    }
    WeightedTerm term;
    term.options.name = text.substr(at, end - at);
    term.term = registry.Make(term.options.name);
    if (end < text.size() && text[end] == '(') {
      const std::size_t close = text.find(')', end);
      if (close == std::string::npos) {
        throw InputError("--terms: '(' of term '" + term.options.name +
                         "' is not closed: expected ')'");
      }
      ParseArguments(text.substr(end + 1, close - end - 1), &term.options);
      end = close + 1;
    }
    energy.push_back(std::move(term));
    at = end;
  }
  if (energy.empty()) {
    throw InputError("--terms is empty: expected one or more of " +
                     AnyOf(registry.names()));
  }
  return energy;
}

void CheckEnergy(const Energy& energy) {
  const bool any = std::any_of(
      energy.begin(), energy.end(),
      [](const WeightedTerm& term) { return term.options.weight > 0; });
  if (!any) {
    throw InputError("--terms: all weights are 0: expected one above 0");
  }
}

std::string EnergyText(const Energy& energy) {
  std::string text;
  for (const WeightedTerm& term : energy) {
    const TermOptions& options = term.options;
    text += (text.empty() ? "" : " ") + options.name +
            "(weight=" + NumberText(options.weight) +
            ",loss=" + ToString(options.loss) +
            ",scale=" + NumberText(options.scale) + ")";
  }
  return text;
}

void SetTermOption(const std::string& key, const std::string& value,
                   const TermRegistry& registry, Energy* energy) {
  const std::size_t dot = key.find('.');
  if (dot == std::string::npos) {
    throw InputError("terms." + key +
                     ": expected terms.NAME.weight, terms.NAME.loss or "
                     "terms.NAME.scale");
  }
  const std::string name = key.substr(0, dot);
  auto found = std::find_if(
      energy->begin(), energy->end(),
      [&](const WeightedTerm& term) { return term.options.name == name; });
  if (found == energy->end()) {
    WeightedTerm term;
    term.options.name = name;
    term.term = registry.Make(name);
    energy->push_back(std::move(term));
    found = energy->end() - 1;
  }
  SetKey(key.substr(dot + 1), value, &found->options);
}

std::map<std::string, std::string> TermOptionValues(const Energy& energy) {
  std::map<std::string, std::string> values;
  for (const WeightedTerm& term : energy) {
    const TermOptions& options = term.options;
    // The same term twice: the second one is "arap.2".
    std::string name = options.name;
    for (int i = 2; values.count(name + ".weight") > 0; ++i) {
      name = options.name + "." + std::to_string(i);
    }
    values[name + ".weight"] = NumberText(options.weight);
    values[name + ".loss"] = ToString(options.loss);
    values[name + ".scale"] = NumberText(options.scale);
  }
  return values;
}

}  // namespace splitfusion
