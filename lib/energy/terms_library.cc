#include "splitfusion/lib/energy/terms_library.h"

#include <dlfcn.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <sstream>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/quoted.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/term_call.h"
#include "splitfusion/lib/energy/term_unknowns.h"
#include "splitfusion/lib/energy/terms_library_file.h"

namespace splitfusion {

namespace {

using AddTerms = void (*)(TermRegistry*);

[[noreturn]] void Refuse(const std::string& path, const std::string& why) {
  throw InputError("--terms_library: " + path + ": " + why);
}

/// The function that adds the terms of a library.
AddTerms Open(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::exists(path, error)) {
    Refuse(path, "no such file: expected a shared library");
  }
  if (!fs::is_regular_file(path, error)) {
    Refuse(path, "expected a shared library");
  }
  const std::string cut_off = WhyCutOff(path);
  if (!cut_off.empty()) Refuse(path, cut_off);
  // What its constructors do, too, is to be told of it. It is never closed:
  // terms that it makes live on.
  const TermCall loading(path, "its library");
  void* library = dlopen(fs::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    Refuse(path, std::string("cannot be loaded: ") + dlerror());
  }
  const void* build = dlsym(library, "SplitFusionTermsBuild");
  void* add = dlsym(library, "SplitFusionAddTerms");
  if (build == nullptr || add == nullptr) {
    Refuse(path, "expected a library with SPLITFUSION_TERMS_LIBRARY(...)");
  }
  const std::string text = SymbolText(build);
  if (text != SPLITFUSION_BUILD) {
    // A text of this kind, or whatever lies there.
    const bool is_one = text.rfind("splitfusion ", 0) == 0;
    Refuse(path, "built with " + (is_one ? text : Quoted(text)) +
                     ": expected " SPLITFUSION_BUILD);
  }
  return reinterpret_cast<AddTerms>(add);
}

/// The names that a library has added.
///
/// @throw InputError if there are none, or others are gone.
std::vector<std::string> NewNames(const TermRegistry& before,
                                  const TermRegistry& after) {
  const std::vector<std::string> old = before.names(), all = after.names();
  const auto kept =
      std::mismatch(old.begin(), old.end(), all.begin(), all.end());
  if (kept.first != old.end()) {
    throw InputError("has removed term '" + *kept.first +
                     "': expected terms that are added");
  }
  if (kept.second == all.end()) {
    throw InputError("adds no term: expected one or more");
  }
  return {kept.second, all.end()};
}

}  // namespace

void LoadTermsLibrary(const std::string& path, TermRegistry* terms) {
  const AddTerms add = Open(path);
  // Of a library that is refused nothing is kept.
  TermRegistry with = *terms;
  const TermCall adding(path, "its library");
  try {
    add(&with);
    for (const std::string& name : NewNames(*terms, with)) {
      DeclaredUnknowns(MakeTerm(name, with));
    }
  } catch (const std::exception& error) {
    Refuse(path, error.what());
  } catch (...) {
    Refuse(path, "threw what is no std::exception");
  }
  *terms = std::move(with);
}

std::vector<std::string> LoadTermsLibraries(const std::string& list,
                                            TermRegistry* terms) {
  std::vector<std::string> paths;
  std::istringstream stream(list);
  for (std::string path; std::getline(stream, path, ',');) {
    CheckOption(!path.empty(), "terms_library", list,
                "files, separated by commas");
    LoadTermsLibrary(path, terms);
    paths.push_back(path);
  }
  return paths;
}

}  // namespace splitfusion
