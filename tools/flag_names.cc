#include "flag_names.h"

#include <gflags/gflags.h>

#include <filesystem>
#include <sstream>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

void NamingFlags(const FlagNames& flags, const std::function<void()>& body) {
  try {
    body();
  } catch (const OptionError& error) {
    const auto found = flags.find(error.field());
    if (found == flags.end()) throw;
    const gflags::CommandLineFlagInfo flag =
        gflags::GetCommandLineFlagInfoOrDie(found->second.c_str());
    if (flag.current_value.empty()) throw;
    throw OptionError(flag.name, FlagValueText(flag.type, flag.current_value),
                      error.expected());
  }
}

bool IsToolFlag(const std::string& name) {
  gflags::CommandLineFlagInfo flag;
  return gflags::GetCommandLineFlagInfo(name.c_str(), &flag) &&
         std::filesystem::path(flag.filename).parent_path().filename() ==
             "tools";
}

std::string FlagValueText(const std::string& type, const std::string& value) {
  if (type != "double") return value;
  std::ostringstream text;
  text << std::stod(value);
  return text.str();
}

}  // namespace splitfusion
