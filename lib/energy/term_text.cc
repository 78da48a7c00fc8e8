#include "splitfusion/lib/energy/term_text.h"

#include <algorithm>
#include <cctype>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/quoted.h"
#include "splitfusion/lib/base/text_file.h"

namespace splitfusion {
namespace {

/// The word of letters, digits and _ that begins at `*at`, which goes behind
/// it.
std::string TakeWord(const std::string& text, std::size_t* at) {
  const auto begin = text.begin() + *at;
  const auto end = std::find_if_not(begin, text.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  });
  *at = end - text.begin();
  return std::string(begin, end);
}

/// "key=value,key=value"
void SplitOptions(const std::string& text, TermText* term) {
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string pair = Trimmed(text.substr(begin, end - begin));
    const std::size_t equals = pair.find('=');
    if (equals == std::string::npos) {
      throw InputError("--terms: '" + pair + "' in term '" + term->name +
                       "': expected key=value");
    }
    const std::string key = Trimmed(pair.substr(0, equals));
    const auto& options = term->options;
    if (std::any_of(options.begin(), options.end(),
                    [&](const auto& option) { return option.first == key; })) {
      throw InputError("--terms: key '" + key + "' stands twice in term '" +
                       term->name + "': expected each key once");
    }
    term->options.emplace_back(key, Trimmed(pair.substr(equals + 1)));
    begin = end + 1;
  }
}

}  // namespace

void CheckName(const std::string& what, const std::string& name) {
  std::size_t end = 0;
  const bool good = !name.empty() && TakeWord(name, &end) == name;
  if (good) return;
  const bool is_plain =
      !name.empty() &&
      std::none_of(name.begin(), name.end(),
                   [](unsigned char c) { return std::iscntrl(c) != 0; });
  throw OptionError(what + " of a term", is_plain ? name : Quoted(name),
                    "letters, digits and _");
}

std::vector<TermText> SplitTerms(const std::string& text) {
  std::vector<TermText> terms;
  std::size_t at = 0;
  while ((at = text.find_first_not_of(" \t\n", at)) != std::string::npos) {
    TermText& term = terms.emplace_back();
    term.name = TakeWord(text, &at);
    if (!term.name.empty() && at < text.size() && text[at] == '.') {
      term.of_class = std::move(term.name);
      term.name = TakeWord(text, &++at);
    }
    if (term.name.empty()) break;
    if (at == text.size() || text[at] != '(') continue;
    const std::size_t close = text.find(')', at);
    if (close == std::string::npos) {
      throw InputError("--terms: '(' of term '" + term.name +
                       "' is not closed: expected ')'");
    }
    SplitOptions(text.substr(at + 1, close - at - 1), &term);
    at = close + 1;
  }
  return terms;
}

}  // namespace splitfusion
