// Libraries of terms that are not to be loaded, or that do what they must not
// meanwhile: it is said which file it was.

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>
#include <vector>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/terms_library.h"
#include "support/environment.h"
#include "support/expect_input_error.h"
#include "support/expect_refused.h"
#include "support/repository.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class HostileLibraries : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"sf_run", "hostile_terms.so", "other_build.so"}) {
      if (!HasProgram(name)) GTEST_SKIP() << name << " is not built";
    }
  }

  /// Expects that files are refused, that the first is named, and that no term
  /// of them is left.
  static void ExpectFile(const std::string& files, const std::string& why) {
    SCOPED_TRACE(files);
    const std::string first = files.substr(0, files.find(','));
    TermRegistry terms = BuiltinTerms();
    ExpectInputError([&] { LoadTermsLibraries(files, &terms); },
                     "--terms_library: " + first + ": " + why);
    if (first != files) return;
    EXPECT_EQ(terms.names(), BuiltinTerms().names());
  }

  const std::string terms_ = (ProgramFolder() / "hostile_terms.so").string();
  TemporaryFolder folder_;
};

TEST_F(HostileLibraries, LoadIfTheyDoNothingWrong) {
  TermRegistry terms = BuiltinTerms();
  EXPECT_EQ(LoadTermsLibraries(terms_, &terms),
            std::vector<std::string>{terms_});
  EXPECT_EQ(terms.names().back(), "hostile");
}

TEST_F(HostileLibraries, AreRefusedBySfRunInOneLine) {
  ExpectRefused("sf_run",
                "--help_terms --terms_library=" + terms_ + "," + terms_,
                "sf_run: --terms_library: " + terms_ +
                    ": term 'hostile': already registered");
  const std::string name = "name a\nb";
  const Environment environment({{"HOSTILE_ADDS", name}});
  ExpectRefused("sf_run", "--help_terms --terms_library=" + terms_,
                terms_ + ": name of a term = 'a\\x0ab': expected letters");
}

TEST_F(HostileLibraries, FilesThatAreNoneAreRefused) {
  ExpectFile(folder_ / "none.so", "no such file: expected a shared library");
  ExpectFile(folder_ / "", "expected a shared library");
  ExpectFile("/dev/zero", "expected a shared library");
  ExpectFile(folder_.Write("empty.so", ""), "cannot be loaded: ");
  ExpectFile(folder_.Write("text.so", "int main() {}\n"), "cannot be loaded: ");
  ExpectFile(folder_.Write("magic.so",
                           "\x7f"
                           "ELF"),
             "cannot be loaded: ");
  ExpectFile(folder_.Write("script.so", "INPUT(" + terms_ + ")\n"),
             "cannot be loaded: ");
  ExpectFile((ProgramFolder() / "sf_run").string(), "cannot be loaded: ");
  Dl_info other;
  ASSERT_NE(dladdr(dlsym(RTLD_DEFAULT, "malloc_usable_size"), &other), 0);
  ExpectFile(other.dli_fname,
             "expected a library with SPLITFUSION_TERMS_LIBRARY(...)");
  ExpectFile((ProgramFolder() / "other_build.so").string(),
             "built with 'old\\x01': expected splitfusion ");
}

TEST_F(HostileLibraries, CopiesThatAreCutOffAreNotMapped) {
  const auto size = static_cast<std::size_t>(fs::file_size(terms_));
  std::ifstream file(terms_, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  ASSERT_EQ(bytes.size(), size);
  for (const std::size_t length :
       {std::size_t{64}, std::size_t{4096}, size / 8, size / 2, size - 1}) {
    ExpectFile(folder_.Write("cut.so", bytes.substr(0, length)),
               "is cut off: " + std::to_string(length) + " bytes, expected ");
  }
}

TEST_F(HostileLibraries, ListsOfThemAreChecked) {
  ExpectFile(terms_ + "," + terms_, "term 'hostile': already registered");
  const std::string link = folder_ / "link.so";
  fs::create_symlink(terms_, link);
  ExpectFile(link + "," + link, "term 'hostile': already registered");
  TermRegistry terms = BuiltinTerms();
  for (const std::string& list : {std::string(","), terms_ + ",,x"}) {
    ExpectInputError(
        [&] { LoadTermsLibraries(list, &terms); },
        "terms_library = " + list + ": expected files, separated by commas");
  }
}

TEST_F(HostileLibraries, WhatTheyAddIsChecked) {
  const std::string letters = ": expected letters, digits and _";
  for (const auto& [adds, message] :
       std::vector<std::pair<std::string, std::string>>{
           {"nothing", "adds no term: expected one or more"},
           {"all_anew", "has removed term 'point_to_plane': expected terms"},
           {"twice", "term 'hostile': already registered"},
           {"null", "term 'hostile': its factory made nothing"},
           {"no_factory", "term 'hostile', its factory: bad_function_call"},
           {"throwing_factory", "term 'hostile', its factory: no"},
           {"out_of_range", "hostile.reach = -1: expected metres > 0"},
           {"two_weights", "term 'hostile' has the key 'weight' twice"},
           {"throws_in_list",
            "term 'hostile', List(): threw what is no std::exception"},
           {"nameless_unknown", "unknown of a term = ''" + letters},
           {"name arap", "term 'arap': already registered"},
           {"name ", "name of a term = ''" + letters},
           {"name my term", "name of a term = my term" + letters},
           {"name a(b", "name of a term = a(b" + letters},
           {"name a,b", "name of a term = a,b" + letters},
           {"name a\nb", "name of a term = 'a\\x0ab'" + letters},
           {"name \xC3\xA4", "name of a term = \xC3\xA4" + letters}}) {
    SCOPED_TRACE(adds);
    const Environment environment({{"HOSTILE_ADDS", adds}});
    ExpectFile(terms_, message);
  }
}

TEST_F(HostileLibraries, WhatTheyThrowIsToldOfTheFile) {
  for (const auto& [way, message] :
       std::vector<std::pair<std::string, std::string>>{
           {"throw", "gone"},
           {"throw_input_error", "a.csv: gone"},
           {"throw_number", "threw what is no std::exception"}}) {
    const Environment environment(
        {{"HOSTILE_WAY", way}, {"HOSTILE_AT", "AddTerms"}});
    ExpectFile(terms_, message);
  }
}

TEST_F(HostileLibraries, EndsFromWithinNameTheFile) {
  const std::string failed = "failed: ", none;
  for (const auto& [way, at, before, message] : std::vector<
           std::tuple<std::string, std::string, std::string, std::string>> {
         {"throw", "loading", failed, "gone"},
             {"throw_number", "loading", failed,
              "ended by an error of unknown"},
             {"throw_where_none_may", "AddTerms", failed, "gone"},
             {"exit", "loading", none, "has called exit()"},
             {"exit", "AddTerms", none, "has called exit()"},
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
             {"segv", "loading", none, "SIGSEGV"},
             {"abort", "AddTerms", none, "SIGABRT"},
#endif
       }) {
    SCOPED_TRACE(way + " at " + at);
    const Environment environment({{"HOSTILE_WAY", way}, {"HOSTILE_AT", at}});
    const ProgramResult result =
        RunProgram("sf_run", "--help_terms --terms_library=" + terms_);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_EQ(result.output, "");
    EXPECT_THAT(result.errors,
                HasSubstr("sf_run: " + before + "term '" + terms_ +
                          "', its library: " + message));
  }
}

}  // namespace
}  // namespace splitfusion
