#include "splitfusion/lib/energy/terms_library.h"

#include <dlfcn.h>

#include <filesystem>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

void LoadTermsLibrary(const std::string& path, TermRegistry* terms) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& why) {
    throw InputError("--terms_library: " + path + ": " + why);
  };
  if (!fs::is_regular_file(path)) refuse("expected a shared library");
  // It is never closed: terms that it makes live on.
  void* library = dlopen(fs::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    refuse(std::string("cannot be loaded: ") + dlerror());
  }
  using Present = TermsLibrary (*)();
  const auto present =
      reinterpret_cast<Present>(dlsym(library, "SplitFusionTerms"));
  if (present == nullptr) {
    refuse("expected a library with SPLITFUSION_TERMS_LIBRARY(...)");
  }
  const TermsLibrary found = present();
  if (found.build != std::string(SPLITFUSION_BUILD)) {
    refuse("built with " + std::string(found.build) +
           ": expected " SPLITFUSION_BUILD);
  }
  found.add(terms);
}

}  // namespace splitfusion
