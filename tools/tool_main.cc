#include "tool_main.h"

#include <fcntl.h>
#include <gflags/gflags.h>
#include <glog/logging.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>
#include <system_error>
#include <vector>

#include "flag_names.h"
#include "flagfile_check.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/process_memory.h"
#include "splitfusion/lib/report/run_marker.h"
#include "splitfusion/lib/report/run_paths.h"
#include "term_ends.h"

DECLARE_bool(help);
DECLARE_bool(helpshort);

namespace GFLAGS_NAMESPACE {
// Called by gflags with 1 after it has printed what is wrong with a flag;
// exported by the library, but declared in none of its public headers.
extern void (*gflags_exitfunc)(int);
}  // namespace GFLAGS_NAMESPACE

namespace splitfusion {
namespace {

/// Makes a program independent of who listens to it; the first call of main().
/// Standard streams that are closed are opened on /dev/null: else the next file
/// that is opened gets their number, and messages go into it. A reader that
/// has gone (`2>&1 | head -1`) and a limit on the size of files (`ulimit -f`)
/// no longer kill the program: writing fails instead.
void SecureStandardStreams() {
  // open() gives the lowest number that is free.
  int descriptor = open("/dev/null", O_RDWR);
  while (descriptor >= 0 && descriptor <= STDERR_FILENO) {
    descriptor = open("/dev/null", O_RDWR);
  }
  if (descriptor >= 0) close(descriptor);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

constexpr std::size_t kColumns = 80;
constexpr std::size_t kTextColumn = 28;

/// Words of `text` in lines from column kTextColumn to kColumns.
std::string Wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string lines;
  std::size_t column = kTextColumn;
  for (std::string word; words >> word;) {
    if (column + word.size() >= kColumns) {
      lines += "\n" + std::string(kTextColumn, ' ');
      column = kTextColumn;
    } else if (column > kTextColumn) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
  }
  return lines;
}

using Flags = std::vector<gflags::CommandLineFlagInfo>;

/// --name=default
std::string FlagText(const gflags::CommandLineFlagInfo& flag) {
  const std::string value = FlagValueText(flag.type, flag.default_value);
  return "--" + flag.name + (value.empty() ? "" : "=" + value);
}

/// A flag a line, or more, with its description.
std::string Described(const Flags& flags) {
  std::string text;
  for (const auto& flag : flags) {
    std::string head = "  " + FlagText(flag);
    if (head.size() + 2 > kTextColumn) {
      head += "\n" + std::string(kTextColumn, ' ');
    } else {
      head.resize(kTextColumn, ' ');
    }
    text += head + Wrapped(flag.description) + '\n';
  }
  return text;
}

/// Names only, in lines up to kColumns.
std::string Listed(const Flags& flags) {
  std::string text, line;
  for (const auto& flag : flags) {
    const std::string entry = "  --" + flag.name;
    if (!line.empty() && line.size() + entry.size() > kColumns) {
      text += line + '\n';
      line.clear();
    }
    line += entry;
  }
  return text + line + '\n';
}

/// The flags of this folder by the file that defines them.
std::map<std::string, Flags> FlagsByFile() {
  Flags flags;
  gflags::GetAllFlags(&flags);
  std::map<std::string, Flags> by_file;
  for (const auto& flag : flags) {
    if (!IsToolFlag(flag.name)) continue;
    by_file[std::filesystem::path(flag.filename).stem().string()].push_back(
        flag);
  }
  return by_file;
}

/// Help that fits a screen: of files with many flags the names only.
void PrintHelp(const std::string& source, const std::string& usage) {
  std::map<std::string, Flags> files = FlagsByFile();
  std::cout << usage << Described(files[source]);
  files.erase(source);
  const bool has_more = files.erase("method_details") > 0;
  const std::size_t many = has_more ? 6 : 20;
  for (const auto& [file, flags] : files) {
    std::cout << file.substr(0, file.find('_'));
    if (flags.size() < many) {
      std::cout << ":\n" << Described(flags);
    } else {
      std::cout << " (--helpon=" << file << " describes them):\n"
                << Listed(flags);
    }
  }
  std::cout << "Also " << (has_more ? "--helpon=method_details, " : "")
            << "--flagfile=FILE (one flag a line), --helpfull.\n";
}

/// @throw InputError if something on the command line is not a flag, but there
///     is no room for it.
void TakeArguments(int argc, char** argv, std::vector<std::string>* arguments) {
  if (arguments != nullptr) {
    arguments->assign(argv + 1, argv + argc);
  } else if (argc > 1) {
    throw InputError("argument '" + std::string(argv[1]) +
                     "': expected flags only, see --help");
  }
}

/// gflags takes the last of several in silence: an experiment would lack the
/// settings of the others.
///
/// @throw InputError if --set is given more than once.
void CheckSetGivenOnce(int argc, char** argv) {
  int given = 0;
  for (int i = 1; i < argc && std::strcmp(argv[i], "--") != 0; ++i) {
    std::string flag = argv[i];
    flag.erase(0, flag.find_first_not_of('-'));
    if (argv[i][0] == '-') given += flag.substr(0, flag.find('=')) == "set";
  }
  if (given < 2) return;
  throw InputError(
      "--set is given " + std::to_string(given) +
      " times: expected all settings in one, --set=\"KEY=VALUE; KEY=VALUE\"");
}

/// False if the program was only asked for help.
bool ParseFlags(int argc, char** argv, const std::string& source,
                const std::string& usage, std::vector<std::string>* arguments) {
  gflags::SetUsageMessage(usage);
  GFLAGS_NAMESPACE::gflags_exitfunc = [](int code) {
    std::exit(code == 0 ? kExitDone : kExitBadInput);
  };
  CheckFlagfiles(argc, argv);
  CheckSetGivenOnce(argc, argv);
  gflags::ParseCommandLineNonHelpFlags(&argc, &argv, /*remove_flags=*/true);
  if (FLAGS_help || FLAGS_helpshort) {
    PrintHelp(source, usage);
    return false;
  }
  gflags::HandleCommandLineHelpFlags();
  TakeArguments(argc, argv, arguments);
  return true;
}

/// Ends the program at once, without what else is done at its end: where memory
/// or threads have run out, that can wait for ever.
[[noreturn]] void EndFailed(const std::string& name, const char* what) {
  std::cout.flush();
  std::cerr << name << ": failed: " << what << std::endl;
  std::_Exit(kExitFailure);
}

/// In place of an abort: what a library's own thread throws, for want of memory
/// or of another thread, cannot be caught.
[[noreturn]] void EndTerminated() {
  const std::string name = gflags::ProgramInvocationShortName();
  try {
    if (const auto error = std::current_exception()) {
      std::rethrow_exception(error);
    }
  } catch (const std::exception& error) {
    EndFailed(name, (RunningTerm() + error.what()).c_str());
  } catch (...) {
  }
  EndFailed(name,
            (RunningTerm() + "ended by an error of unknown kind").c_str());
}

}  // namespace

int ToolMain(int argc, char** argv, const std::string& usage,
             const std::function<int()>& body, const std::string& source,
             std::vector<std::string>* arguments) {
  SecureStandardStreams();
  const std::string name = std::filesystem::path(argv[0]).filename().string();
  KeepFreedMemory();
  std::set_terminate(EndTerminated);
  const char* slash = std::strrchr(argv[0], '/');
  NameTermsThatEnd(slash == nullptr ? argv[0] : slash + 1);
  FLAGS_logtostderr = true;
  google::InitGoogleLogging(argv[0]);
  try {
    return ParseFlags(argc, argv, source.empty() ? name : source, usage,
                      arguments)
               ? body()
               : kExitDone;
  } catch (const OptionError& error) {
    std::cerr << name << ": " << (IsToolFlag(error.field()) ? "--" : "")
              << error.what() << '\n';
    return kExitBadInput;
  } catch (const InputError& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return kExitBadInput;
  } catch (const std::exception& error) {
    EndFailed(name, error.what());
  }
}

void CheckIsOutside(const std::string& field, const std::string& path,
                    const std::string& folder, const std::string& folder_name) {
  namespace fs = std::filesystem;
  if (path.empty()) return;
  const fs::path outer = fs::weakly_canonical(fs::absolute(folder));
  const fs::path inner = fs::weakly_canonical(fs::absolute(path));
  const auto end =
      std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
  CheckOption(end.first != outer.end(), field, path,
              "a folder outside of " + folder_name);
}

void CheckIsNoFileOfARun(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(path, error);
  if (error || !fs::exists(whole, error)) return;
  for (fs::path folder = whole.parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    const RunPaths paths(folder.string());
    if (!fs::exists(paths.Marker(), error)) continue;
    if (whole == paths.Evaluation() || whole == paths.HtmlReport()) return;
    const std::optional<RunMarker> marker = ReadRunMarker(folder.string());
    const std::string name = whole.lexically_relative(folder).string();
    if (whole != paths.Marker() && marker->files.count(name) == 0) continue;
    throw InputError("--output=" + path +
                     ": is a file of a run: expected another one");
  }
}

}  // namespace splitfusion
