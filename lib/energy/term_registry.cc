#include "splitfusion/lib/energy/term_registry.h"

#include <algorithm>
#include <set>
#include <utility>

#include "splitfusion/lib/base/any_of.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/term_call.h"
#include "splitfusion/lib/energy/term_unknowns.h"

namespace splitfusion {
namespace {

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
    CallTerm(term_->options.name, "List()", [&] { term_->term->List(list); });
  }

 private:
  WeightedTerm* term_;
  std::string loss_;
  OptionList list_;
};

}  // namespace

WeightedTerm MakeTerm(const std::string& name, const TermRegistry& registry) {
  registry.Check(name);
  CheckName("name", name);
  WeightedTerm term;
  term.options.name = name;
  term.term = CallTerm(name, "its factory", [&] {
    return std::shared_ptr<EnergyTerm>(registry.Make(name));
  });
  if (term.term == nullptr) {
    throw InputError("term '" + name + "': its factory made nothing");
  }
  TermKeys(&term).Check();
  return term;
}

void CheckTerm(const WeightedTerm& term) {
  // Squares of the scale are taken, in units of 1 cm.
  constexpr double kLeastScale = 1e-100, kLargestScale = 1e100;  // Maths.
  const TermOptions& options = term.options;
  if (term.term == nullptr) {
    throw InputError("term '" + options.name + "': expected a term, not null");
  }
  CheckOption(options.weight >= 0, options.name + ".weight", options.weight,
              ">= 0");
  if (options.loss == LossKind::kTrivial) return;
  const std::string loss = ToString(options.loss);
  CheckOption(MakeLoss(options.loss, 1) != nullptr, options.name + ".loss",
              loss, AnyOf(LossNames()));
  CheckOption(options.scale >= kLeastScale && options.scale <= kLargestScale,
              options.name + ".scale", options.scale,
              "metres 1e-100..1e100 with loss " + loss);
}

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
    CheckTerm(term);
    TermKeys(&term).Check();
    DeclaredUnknowns(term);
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
  std::map<std::string, int> counts;
  for (WeightedTerm term : energy) {
    const TermKeys keys(&term);
    // The same term twice: the second one is "arap.2".
    std::string name = term.options.name;
    const int count = ++counts[name];
    if (count > 1) name += "." + std::to_string(count);
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
    CallTerm(name, "List()", [&] { term.term->List(&own); });
    for (const Option& option : own.options()) {
      text += "  " + option.name + " = " + option.ValueText() + " (" +
              option.Expected() + ")\n      " + option.help + "\n";
    }
  }
  return text;
}

}  // namespace splitfusion
