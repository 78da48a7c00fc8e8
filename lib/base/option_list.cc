#include "splitfusion/lib/base/option_list.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "splitfusion/lib/base/any_of.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/number_text.h"

namespace splitfusion {
namespace {

/// Reads all of `text`; false if it is no number of this kind.
template <typename T>
bool ReadNumber(const std::string& text, T* number) {
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, *number);
  return read.ec == std::errc() && read.ptr == end;
}

bool ReadValue(const std::string& text, bool* value) {
  *value = text == "true";
  return *value || text == "false";
}
bool ReadValue(const std::string& text, int* value) {
  return ReadNumber(text, value);
}
bool ReadValue(const std::string& text, double* value) {
  return ReadNumber(text, value);
}
bool ReadValue(const std::string& text, std::string* value) {
  *value = text;
  return true;
}

}  // namespace

bool Range::Holds(double value) const {
  return std::isfinite(value) && (above_low ? value > low : value >= low) &&
         (below_high ? value < high : value <= high);
}

std::string Range::Text(const std::string& unit) const {
  const bool from = std::isfinite(low), to = std::isfinite(high);
  const std::string before = unit.empty() ? "" : unit + " ";
  const std::string after = unit.empty() ? "" : " " + unit;
  if (!from && !to) return "a number" + (unit.empty() ? "" : " of " + unit);
  if (!to) return before + (above_low ? "> " : ">= ") + NumberText(low);
  if (!from) return before + (below_high ? "< " : "<= ") + NumberText(high);
  std::string text = NumberText(low) + ".." + NumberText(high) + after;
  if (above_low) text += ", not " + NumberText(low);
  if (below_high) text += ", not " + NumberText(high);
  return text;
}

std::string Option::Expected() const {
  if (std::holds_alternative<bool*>(value)) return "true or false";
  if (std::holds_alternative<std::string*>(value)) {
    return choices.empty() ? "a text" : AnyOf(choices);
  }
  return range.Text(unit);
}

std::string Option::ValueText() const {
  if (const auto* text = std::get_if<std::string*>(&value)) return **text;
  if (const auto* on = std::get_if<bool*>(&value)) {
    return **on ? "true" : "false";
  }
  if (const auto* count = std::get_if<int*>(&value)) {
    return std::to_string(**count);
  }
  return NumberText(*std::get<double*>(value));
}

bool Option::Fits() const {
  if (const auto* number = std::get_if<double*>(&value)) {
    return range.Holds(**number);
  }
  if (const auto* count = std::get_if<int*>(&value))
    return range.Holds(**count);
  const auto* text = std::get_if<std::string*>(&value);
  return text == nullptr || choices.empty() ||
         std::count(choices.begin(), choices.end(), **text) > 0;
}

void Option::Check() const {
  if (!Fits()) throw OptionError(name, ValueText(), Expected());
}

void Option::Set(const std::string& text) {
  std::visit(
      [&](auto* field) {
        const auto before = *field;
        if (ReadValue(text, field) && Fits()) return;
        *field = before;
        throw OptionError(name, text, Expected());
      },
      value);
}

Option& OptionList::Number(const std::string& name, int* value,
                           const Range& range, const std::string& unit,
                           const std::string& help) {
  return options_.emplace_back(
      Option{prefix_ + name, value, range, {}, unit, help});
}

Option& OptionList::Number(const std::string& name, double* value,
                           const Range& range, const std::string& unit,
                           const std::string& help) {
  return options_.emplace_back(
      Option{prefix_ + name, value, range, {}, unit, help});
}

Option& OptionList::Switch(const std::string& name, bool* value,
                           const std::string& help) {
  return options_.emplace_back(Option{prefix_ + name, value, {}, {}, "", help});
}

Option& OptionList::Choice(const std::string& name, std::string* value,
                           const std::vector<std::string>& choices,
                           const std::string& help) {
  return options_.emplace_back(
      Option{prefix_ + name, value, {}, choices, "", help});
}

Option& OptionList::Text(const std::string& name, std::string* value,
                         const std::string& help) {
  return options_.emplace_back(Option{prefix_ + name, value, {}, {}, "", help});
}

void OptionList::Demand(bool holds, const std::string& name,
                        const std::string& expected) {
  if (holds) return;
  for (std::size_t i = options_.size(); i-- > 0;) {
    if (options_[i].name != prefix_ + name) continue;
    violations_.emplace_back(i, expected);
    return;
  }
  throw std::logic_error("no option " + prefix_ + name);
}

void OptionList::Check() const {
  for (const Option& option : options_) option.Check();
  if (violations_.empty()) return;
  const auto& [index, expected] = violations_.front();
  throw OptionError(options_[index].name, options_[index].ValueText(),
                    expected);
}

}  // namespace splitfusion
