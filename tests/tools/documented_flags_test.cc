// The commands in README.md and docs/ name flags that the programs have.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/program.h"
#include "support/repository.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using Flags = std::set<std::string>;

constexpr const char* kPrograms[] = {"sf_convert", "sf_batch",  "sf_evaluate",
                                     "sf_montage", "sf_export", "sf_refine",
                                     "sf_report",  "sf_run",    "sf_segment",
                                     "sf_solve",   "sf_synth"};

/// One flag in a page.
struct Mention {
  std::string place;    ///< FILE:LINE.
  std::string program;  ///< That the command calls; empty in running text.
  std::string flag;     ///< Without dashes.
};

/// Every `--flag` of a text.
std::vector<std::string> FlagsIn(const std::string& text) {
  static const std::regex flag(R"((^|[\s`"'(\[|])--([a-z][a-z_]*))");
  std::vector<std::string> flags;
  for (std::sregex_iterator i(text.begin(), text.end(), flag), end; i != end;
       ++i) {
    flags.push_back((*i)[2]);
  }
  return flags;
}

/// Program that a line of a code block calls; "other" if it begins with a word
/// that is none of ours; empty if the line goes on with the one before.
std::string ProgramOf(const std::string& line, bool continued) {
  static const std::regex ours(
      R"((sf_[a-z]+|compare_presets\.sh|quickstart\.sh)(\s|$))");
  std::smatch found;
  if (std::regex_search(line, found, ours)) return found[1];
  const bool goes_on =
      continued || line.empty() || line[0] == ' ' || line.rfind("--", 0) == 0;
  return goes_on ? "" : "other";
}

std::vector<Mention> ReadPage(const fs::path& path) {
  std::vector<Mention> mentions;
  std::ifstream stream(path);
  bool in_block = false, continued = false;
  std::string program, line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.rfind("```", 0) == 0) {
      in_block = !in_block;
      program.clear();
      continue;
    }
    if (in_block) {
      const std::string called = ProgramOf(line, continued);
      if (!called.empty()) program = called;
      continued = !line.empty() && line.back() == '\\';
    }
    const std::string place =
        path.filename().string() + ":" + std::to_string(number);
    for (const std::string& flag : FlagsIn(line)) {
      mentions.push_back({place, in_block ? program : "", flag});
    }
  }
  return mentions;
}

std::vector<Mention> ReadPages() {
  const fs::path root = RepositoryRoot();
  std::vector<fs::path> pages = {root / "README.md", root / "CONTRIBUTING.md"};
  for (const auto& entry : fs::directory_iterator(root / "docs")) {
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  }
  std::vector<Mention> mentions;
  for (const fs::path& page : pages) {
    for (Mention& mention : ReadPage(page)) mentions.push_back(mention);
  }
  return mentions;
}

/// Every option of the method, of which --help shows the common ones.
Flags MethodOptions() {
  static const std::regex row(R"(\| `([a-z_]+)` \|)");
  const std::string table = RunProgram("sf_run", "--print_options").output;
  Flags names;
  for (std::sregex_iterator i(table.begin(), table.end(), row), end; i != end;
       ++i) {
    names.insert((*i)[1]);
  }
  return names;
}

/// Flags that every program and script takes, by its name.
std::map<std::string, Flags> KnownFlags() {
  std::map<std::string, Flags> known;
  for (const char* program : kPrograms) {
    known[program] = {"help", "helpfull", "helpon", "flagfile"};
    const std::string help = RunProgram(program, "--help").output;
    std::size_t begin = 0;
    while ((begin = help.find("  --", begin)) != std::string::npos) {
      begin += 4;
      known[program].insert(
          help.substr(begin, help.find_first_of("= \n", begin) - begin));
    }
  }
  for (const std::string& name : MethodOptions()) known["sf_run"].insert(name);
  known["compare_presets.sh"] = known["quickstart.sh"] = known["sf_run"];
  return known;
}

/// Flags that the comment at the top of a script lists.
Flags FlagsOfScript(const std::string& path) {
  static const std::regex listed(R"(^#   --([a-z_]+) .*)");
  std::ifstream stream(RepositoryRoot() / path);
  Flags flags;
  std::smatch found;
  for (std::string line; std::getline(stream, line);) {
    if (std::regex_match(line, found, listed)) flags.insert(found[1]);
  }
  return flags;
}

TEST(DocumentedFlags, OptionsOfTheMethodAreListedAsTheyAre) {
  std::ifstream stream(RepositoryRoot() / "docs/options.md");
  if (!stream) GTEST_SKIP() << "not built in the repository";
  const std::string page{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_EQ(page, RunProgram("sf_run", "--print_options").output)
      << "sf_run --print_options >docs/options.md makes it anew";
  EXPECT_GT(MethodOptions().size(), 60u);
}

TEST(DocumentedFlags, AreThoseOfThePrograms) {
  if (!fs::exists(RepositoryRoot() / "docs/report_format.md")) {
    GTEST_SKIP() << "not built in the repository";
  }
  for (const char* program : kPrograms) {
    if (!HasProgram(program)) GTEST_SKIP() << program << " is not built";
  }
  const std::map<std::string, Flags> known = KnownFlags();
  // Of cmake and ctest.
  Flags any = {"build", "install", "prefix", "preset", "target", "parallel"};
  any.insert("input");  // Of Open3D.
  // Of sbatch, squeue, apt-get, apptainer and tests/slurm.sh.
  any.insert({"array", "bind", "cpus", "fakeroot", "me", "mem", "no",
              "no_install", "open", "partition", "requeue", "time"});
  for (const auto& [program, flags] : known) {
    any.insert(flags.begin(), flags.end());
  }
  const Flags of_benchmarks = FlagsOfScript("tools/benchmark/run.sh");
  any.insert(of_benchmarks.begin(), of_benchmarks.end());
  int in_commands = 0;
  for (const Mention& mention : ReadPages()) {
    const auto found = known.find(mention.program);
    const bool is_ours = found != known.end();
    const Flags& flags = is_ours ? found->second : any;
    in_commands += is_ours;
    EXPECT_EQ(flags.count(mention.flag), 1u)
        << mention.place << ": " << mention.program << " has no --"
        << mention.flag;
  }
  EXPECT_GT(in_commands, 40);
}

TEST(TermsPage, NamesEveryTermAndKey) {
  if (!HasProgram("sf_run")) GTEST_SKIP() << "sf_run is not built";
  std::ifstream stream(RepositoryRoot() / "docs/terms.md");
  const std::string page{std::istreambuf_iterator<char>(stream), {}};
  std::istringstream help(RunProgram("sf_run", "--help_terms").output);
  int named = 0;
  for (std::string line; std::getline(help, line);) {
    // Names stand alone at the margin, keys as "  KEY = VALUE".
    const bool term = !line.empty() && line[0] != ' ';
    const bool key = line.rfind("  ", 0) == 0 && line[2] != ' ' &&
                     line.find(" = ") != std::string::npos;
    if (!term && !key) continue;
    const std::string name =
        line.substr(term ? 0 : 2, line.find(' ', 2) - (term ? 0 : 2));
    EXPECT_NE(page.find("`" + name + "`"), std::string::npos) << name;
    ++named;
  }
  EXPECT_GE(named, 11);
}

}  // namespace
}  // namespace splitfusion
