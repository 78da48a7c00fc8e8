#ifndef SPLITFUSION_TOOLS_TOOL_MAIN_H_
#define SPLITFUSION_TOOLS_TOOL_MAIN_H_

#include <functional>
#include <string>
#include <vector>

namespace splitfusion {

/// Exit codes of all tools.
enum ExitCode {
  kExitDone = 0,        ///< Done.
  kExitFailure = 1,     ///< Anything that is not one of the others.
  kExitBadInput = 2,    ///< Bad usage or input; one line on stderr says what.
  kExitFailedRuns = 3,  ///< A batch with failed runs.
};

/// The main() of a tool: starts glog (to stderr), parses the flags, runs `body`
/// and turns exceptions into exit codes, InputError into kExitBadInput. Where
/// an OptionError is about a field that is named as a flag, the message names
/// the flag.
///
/// Unknown flags, bad values and arguments that are not flags end the program
/// with kExitBadInput and one line on stderr. `--help` prints `usage` and the
/// flags that are defined in this folder, and ends it with kExitDone.
///
/// `usage`: what the tool does and how it is called; whole lines. `source`: the
/// file, without its extension, that defines the tool's own flags; empty: that
/// of the program's name. `arguments`: receives what on the command line is no
/// flag; null: there may be none.
int ToolMain(int argc, char** argv, const std::string& usage,
             const std::function<int()>& body, const std::string& source = "",
             std::vector<std::string>* arguments = nullptr);

/// Refuses a path that is a folder or lies in it, through whatever links.
/// `field`: names the path, which may be empty. `folder_name`: as in "--output,
/// which is overwritten".
///
/// @throw OptionError if it does.
void CheckIsOutside(const std::string& field, const std::string& path,
                    const std::string& folder, const std::string& folder_name);

/// Refuses --output=PATH where that is a file of a run, other than its
/// evaluation and its page, which can be made again.
///
/// @throw InputError if it is.
void CheckIsNoFileOfARun(const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_TOOL_MAIN_H_
