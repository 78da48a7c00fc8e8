#include "method_flags.h"

#include <gflags/gflags.h>

#include <deque>
#include <type_traits>
#include <variant>

namespace splitfusion {
namespace {

/// The options as the flags state them, and their defaults. gflags keeps
/// pointers into both, and to the texts, to the program's end.
struct FlagStorage {
  FlagStorage() {
    options.List(&list);
    depth.List(&list);
    defaults.List(&default_list);
    default_depth.List(&default_list);
  }

  PipelineOptions options, defaults;
  DepthOptions depth, default_depth;
  OptionList list, default_list;
  std::deque<std::string> help;
};

FlagStorage& Storage() {
  static FlagStorage storage;
  return storage;
}

std::string HelpOf(const Option& option) {
  return option.help + (option.unit.empty() ? "" : " [" + option.unit + "]");
}

/// The option with its default in a row of the table.
std::string Row(const Option& option, const Registries& registries) {
  std::string expected = option.Expected();
  if (option.name == "solver") expected = AnyOf(registries.solvers.names());
  if (option.name == "association") {
    expected = AnyOf(registries.associations.names());
  }
  return "| `" + option.name + "` | `" + option.ValueText() + "` | " +
         expected + " | " + option.help + " |\n";
}

/// Sets those of `options` whose flags were given, and the flags to all.
template <typename Options>
void TakeGiven(Options* options, Options* flags) {
  OptionList list, given;
  options->List(&list);
  flags->List(&given);
  for (std::size_t i = 0; i < list.options().size(); ++i) {
    const Option& option = list.options()[i];
    if (gflags::GetCommandLineFlagInfoOrDie(option.name.c_str()).is_default) {
      continue;
    }
    std::visit(
        [&](auto* value) {
          *value = *std::get<decltype(value)>(given.options()[i].value);
        },
        option.value);
  }
  *flags = *options;
}

}  // namespace

void RegisterMethodFlags() {
  FlagStorage& storage = Storage();
  for (std::size_t i = 0; i < storage.list.options().size(); ++i) {
    const Option& option = storage.list.options()[i];
    storage.help.push_back(HelpOf(option));
    const char* file =
        option.common ? "tools/method_flags.cc" : "tools/method_details.cc";
    std::visit(
        [&](auto* value) {
          using Pointer = decltype(value);
          gflags::FlagRegisterer(
              option.name.c_str(), storage.help.back().c_str(), file, value,
              std::get<Pointer>(storage.default_list.options()[i].value));
        },
        option.value);
  }
}

PipelineOptions& MethodFlags() { return Storage().options; }

void TakeDepthFlags(DepthOptions* depth) { TakeGiven(depth, &Storage().depth); }

void TakeMethodFlags(PipelineOptions* options) {
  TakeGiven(options, &Storage().options);
}

std::string MethodOptionsMarkdown(const Registries& registries) {
  std::string text =
      "# Options of the method\n\n"
      "Every option of the method is a flag of `sf_run` and a key of "
      "experiments\n(docs/experiments.md). Presets change defaults; flags on "
      "the command line or in\na flagfile override the preset. Made by `sf_run "
      "--print_options`.\n";
  for (const bool common : {true, false}) {
    text += std::string("\n## ") +
            (common ? "Common options" : "Other options") +
            "\n\n| option | default | range | meaning |\n|---|---|---|---|\n";
    for (const Option& option : Storage().default_list.options()) {
      if (option.common == common) text += Row(option, registries);
    }
  }
  return text;
}

}  // namespace splitfusion
