#include "splitfusion/lib/energy/terms_library.h"

#include <dlfcn.h>

#include <filesystem>
#include <sstream>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

void LoadTermsLibrary(const std::string& path, TermRegistry* terms) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& why) {
    throw InputError("--terms_library: " + path + ": " + why);
  };
  std::error_code error;
  if (!fs::is_regular_file(path, error)) refuse("expected a shared library");
  // It is never closed: terms that it makes live on.
  void* library = dlopen(fs::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    refuse(std::string("cannot be loaded: ") + dlerror());
  }
  const auto* build =
      static_cast<const char*>(dlsym(library, "SplitFusionTermsBuild"));
  using Add = void (*)(TermRegistry*);
  const auto add = reinterpret_cast<Add>(dlsym(library, "SplitFusionAddTerms"));
  if (build == nullptr || add == nullptr) {
    refuse("expected a library with SPLITFUSION_TERMS_LIBRARY(...)");
  }
  if (build != std::string(SPLITFUSION_BUILD)) {
    refuse("built with " + std::string(build) +
           ": expected " SPLITFUSION_BUILD);
  }
  try {
    add(terms);
  } catch (const InputError& clash) {
    refuse(clash.what());
  }
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
