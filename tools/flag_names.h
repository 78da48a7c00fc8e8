#ifndef SPLITFUSION_TOOLS_FLAG_NAMES_H_
#define SPLITFUSION_TOOLS_FLAG_NAMES_H_

#include <functional>
#include <map>
#include <string>

namespace splitfusion {

/// Fields of an option struct -> flags of another name that set them.
using FlagNames = std::map<std::string, std::string>;

/// Runs `body`. An OptionError on a field of `flags` becomes one that names the
/// flag, with its value as typed (a flag without a value is left out: the field
/// has its value from elsewhere). Fields named as their flag need no entry:
/// ToolMain knows them.
///
/// @throw OptionError as said, and what else `body` throws.
void NamingFlags(const FlagNames& flags, const std::function<void()>& body);

/// Whether one of the tools defines a flag of that name.
bool IsToolFlag(const std::string& name);

/// Value of a flag as one would write it: 0.3, not 0.29999999999999999.
/// `type`: gflags' name of the flag's type.
std::string FlagValueText(const std::string& type, const std::string& value);

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_FLAG_NAMES_H_
