#include "flagfile_check.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/quoted.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// One argument or line, as gflags takes it apart.
struct FlagText {
  std::string name;
  std::string value;
  bool has_value = false;
};

bool IsFlagfile(const std::string& name) { return name == "flagfile"; }

/// `text`: with one or two dashes; a name may be empty.
FlagText ParseFlag(const std::string& text) {
  const std::string body = text.substr(text.compare(0, 2, "--") == 0 ? 2 : 1);
  const std::size_t equals = body.find('=');
  if (equals == std::string::npos) return {body, "", false};
  return {body.substr(0, equals), body.substr(equals + 1), true};
}

bool IsSwitch(const std::string& name) {
  gflags::CommandLineFlagInfo info;
  return gflags::GetCommandLineFlagInfo(name.c_str(), &info) &&
         info.type == "bool";
}

/// What is wrong with a flag in a file; empty if nothing is.
std::string Complaint(const FlagText& flag) {
  std::string value;
  if (gflags::GetCommandLineOption(flag.name.c_str(), &value)) {
    if (flag.has_value || IsSwitch(flag.name)) return "";
    return "flag without a value: expected --" + flag.name + "=VALUE";
  }
  const bool negated = flag.name.rfind("no", 0) == 0 && !flag.has_value &&
                       IsSwitch(flag.name.substr(2));
  if (negated) return "";
  if (flag.name.find_first_of(" \t") != std::string::npos) {
    return "expected --flag=value without blanks around the sign";
  }
  return "unknown flag " + Quoted(flag.name) + ", see --help";
}

/// A flagfile and those on the way to it.
class FlagfileChecker {
 public:
  /// `list`: files separated by commas, as gflags takes them.
  void CheckList(const std::string& list) {
    std::stringstream names(list);
    for (std::string name; std::getline(names, name, ',');) CheckFile(name);
  }

 private:
  void CheckFile(const std::string& name) {
    std::error_code error;
    if (!fs::exists(name, error)) {
      throw InputError("flagfile " + Quoted(name) + ": no such file");
    }
    if (!fs::is_regular_file(name, error)) {
      throw InputError("flagfile " + Quoted(name) +
                       ": expected a regular file, one flag a line");
    }
    const std::string path = fs::canonical(name, error).string();
    if (std::count(open_.begin(), open_.end(), path) > 0) {
      throw InputError("flagfile " + Quoted(name) +
                       ": names itself as a flagfile, or over others");
    }
    open_.push_back(path);
    CheckLines(name);
    open_.pop_back();
  }

  void CheckLines(const std::string& name) {
    std::ifstream file(name, std::ios::binary);
    if (!file) {
      throw InputError("flagfile " + Quoted(name) + ": cannot be opened");
    }
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
      const std::size_t begin = line.find_first_not_of(" \t\r");
      if (begin == std::string::npos || line[begin] == '#') continue;
      CheckLine(name + ", line " + std::to_string(number) + ": ",
                line.substr(begin));
    }
  }

  /// `place`: for the message.
  void CheckLine(const std::string& place, const std::string& line) {
    const auto is_control = [](unsigned char c) {
      return c < 0x20 && c != '\t';
    };
    const bool plain = std::none_of(
        line.begin(), line.end() - (line.back() == '\r' ? 1 : 0), is_control);
    if (line[0] != '-' || !plain) {
      throw InputError(place + Quoted(line) +
                       ": expected --flag=value, or # before a comment");
    }
    const FlagText flag = ParseFlag(line);
    const std::string complaint = Complaint(flag);
    if (!complaint.empty()) {
      throw InputError(place + complaint);
    }
    if (IsFlagfile(flag.name)) CheckList(flag.value);
  }

  std::vector<std::string> open_;
};

}  // namespace

void CheckFlagfiles(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (argv[i][0] != '-') continue;
    if (std::strcmp(argv[i], "--") == 0) return;
    const FlagText flag = ParseFlag(argv[i]);
    if (!IsFlagfile(flag.name)) continue;
    if (!flag.has_value && i + 1 == argc) return;  // gflags says so.
    FlagfileChecker().CheckList(flag.has_value ? flag.value : argv[i + 1]);
  }
}

}  // namespace splitfusion
