#include "splitfusion/lib/energy/term_registry.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <utility>

#include "splitfusion/lib/base/any_of.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {
namespace {

/// Names stand in texts like "name(key=value)".
void CheckName(const std::string& what, const std::string& name) {
  const bool good =
      !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
      });
  CheckOption(good, what + " of a term", name.empty() ? "''" : name,
              "letters, digits and _");
}

/// The keys of a term: weight, loss and scale, then those of its own.
class TermKeys {
 public:
  explicit TermKeys(WeightedTerm* term)
      : term_(term), loss_(ToString(term->options.loss)) {
    list_.Part(term->options.name + ".", this);
    std::set<std::string> names;
    for (const Option& option : all()) {
      CheckName("key", KeyOf(option));
      if (names.insert(option.name).second) continue;
      throw InputError("term '" + term->options.name + "' has the key '" +
                       KeyOf(option) + "' twice");
    }
  }
  TermKeys(const TermKeys&) = delete;
  TermKeys& operator=(const TermKeys&) = delete;

  /// @throw OptionError if a value, or a default, is not what is expected.
  void Check() const { list_.Check(); }

  /// Names begin with that of the term and a dot.
  const std::vector<Option>& all() const { return list_.options(); }

  /// @throw InputError if the key is unknown or the value is refused.
  void Set(const std::string& key, const std::string& value) {
    std::vector<std::string> known;
    for (Option option : all()) {
      known.push_back(KeyOf(option));
      if (known.back() != key) continue;
      CheckOption(value.find_first_of("(),") == std::string::npos, option.name,
                  value, "a value without brackets and commas");
      option.Set(value);
      term_->options.loss = ParseLoss(loss_);
      return;
    }
    throw InputError("--terms: key '" + key + "' of term '" +
                     term_->options.name + "': expected " + AnyOf(known));
  }

  /// The name less that of the term.
  std::string KeyOf(const Option& option) const {
    return option.name.substr(term_->options.name.size() + 1);
  }

  void List(OptionList* list) {
    list->Number("weight", &term_->options.weight, Range::AtLeast(0), "",
                 "Of the term in the energy, which is a mean over residuals in "
                 "units of 1 cm.");
    list->Choice("loss", &loss_, LossNames(),
                 "Robust loss of every residual vector.");
    list->Number("scale", &term_->options.scale, Range::Above(0), "metres",
                 "Inlier width of the loss.");
    term_->term->List(list);
  }

 private:
  WeightedTerm* term_;
  std::string loss_;
  OptionList list_;
};

/// @throw InputError on unknowns that a term must not declare.
void CheckUnknowns(const WeightedTerm& term) {
  std::set<std::string> names;
  for (const Unknown& unknown : term.term->Unknowns()) {
    CheckName("unknown", unknown.name);
    const std::string name = term.options.name + "." + unknown.name;
    CheckOption(names.insert(unknown.name).second, "unknown of a term", name,
                "names that differ");
    CheckOption(std::isfinite(unknown.initial), "initial of unknown " + name,
                unknown.initial, "a finite number");
    CheckOption(std::isfinite(unknown.scale) && unknown.scale > 0,
                "scale of unknown " + name, unknown.scale, "a number above 0");
  }
}

WeightedTerm MakeTerm(const std::string& name, const TermRegistry& registry) {
  WeightedTerm term;
  term.options.name = name;
  term.term = registry.Make(name);
  CheckName("name", name);
  if (term.term == nullptr) {
    throw InputError("term '" + name + "': its factory made nothing");
  }
  TermKeys(&term).Check();
  return term;
}

}  // namespace

Energy MakeEnergy(const std::vector<TermText>& terms,
                  const TermRegistry& registry) {
  Energy energy;
  for (const TermText& text : terms) {
    if (!text.of_class.empty()) {
      throw InputError("--terms: '" + text.of_class + "." + text.name +
                       "': expected a term of all surfaces");
    }
    energy.push_back(MakeTerm(text.name, registry));
    TermKeys keys(&energy.back());
    for (const auto& [key, value] : text.options) keys.Set(key, value);
  }
  if (energy.empty()) {
    throw InputError("--terms is empty: expected one or more of " +
                     AnyOf(registry.names()));
  }
  return energy;
}

Energy ParseEnergy(const std::string& text, const TermRegistry& registry) {
  return MakeEnergy(SplitTerms(text), registry);
}

void CheckEnergy(const Energy& energy) {
  for (WeightedTerm term : energy) {
    TermKeys(&term).Check();
    CheckUnknowns(term);
  }
  const bool any = std::any_of(
      energy.begin(), energy.end(),
      [](const WeightedTerm& term) { return term.options.weight > 0; });
  if (!any) {
    throw InputError("--terms: all weights are 0: expected one above 0");
  }
}

std::string EnergyText(const Energy& energy) {
  std::string text;
  for (WeightedTerm term : energy) {
    const TermKeys keys(&term);
    std::string values;
    for (const Option& option : keys.all()) {
      values += (values.empty() ? "" : ",") + keys.KeyOf(option) + "=" +
                option.ValueText();
    }
    text += (text.empty() ? "" : " ") + term.options.name + "(" + values + ")";
  }
  return text;
}

void SetTermOption(const std::string& key, const std::string& value,
                   const TermRegistry& registry, Energy* energy) {
  const std::size_t dot = key.find('.');
  if (dot == std::string::npos) {
    throw InputError("terms." + key + ": expected terms.NAME.KEY, as in " +
                     "terms.arap.weight");
  }
  const std::string name = key.substr(0, dot);
  auto found = std::find_if(
      energy->begin(), energy->end(),
      [&](const WeightedTerm& term) { return term.options.name == name; });
  if (found == energy->end()) {
    energy->push_back(MakeTerm(name, registry));
    found = energy->end() - 1;
  }
  TermKeys(&*found).Set(key.substr(dot + 1), value);
}

std::map<std::string, std::string> TermOptionValues(const Energy& energy) {
  std::map<std::string, std::string> values;
  for (WeightedTerm term : energy) {
    const TermKeys keys(&term);
    // The same term twice: the second one is "arap.2".
    std::string name = term.options.name;
    for (int i = 2; values.count(name + ".weight") > 0; ++i) {
      name = term.options.name + "." + std::to_string(i);
    }
    for (const Option& option : keys.all()) {
      values[name + "." + keys.KeyOf(option)] = option.ValueText();
    }
  }
  return values;
}

std::string TermsHelp(const TermRegistry& registry) {
  std::string text =
      "  Every term takes weight (1 if it is not given), loss (trivial, huber, "
      "tukey,\n  cauchy; trivial) and scale of the loss (0.01 metres), and "
      "what is listed below it.\n";
  for (const std::string& name : registry.names()) {
    WeightedTerm term = MakeTerm(name, registry);
    text += name + "\n";
    OptionList own;
    term.term->List(&own);
    for (const Option& option : own.options()) {
      text += "  " + option.name + " = " + option.ValueText() + " (" +
              option.Expected() + ")\n      " + option.help + "\n";
    }
  }
  return text;
}

}  // namespace splitfusion
