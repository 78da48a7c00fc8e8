#ifndef SPLITFUSION_LIB_ENERGY_TERMS_LIBRARY_H_
#define SPLITFUSION_LIB_ENERGY_TERMS_LIBRARY_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "splitfusion/lib/energy/term_registry.h"
#include "splitfusion/method_hash.h"

/// Text of a macro's value.
#define SPLITFUSION_TEXT(value) SPLITFUSION_TEXT_OF(value)
/// Text of a macro's argument.
#define SPLITFUSION_TEXT_OF(value) #value

/// What a program and a library of terms must have been built with alike, or
/// they would read each other's memory wrongly: version and sources of the
/// toolkit, compiler, and what decides the layout of the standard library's and
/// Eigen's types.
#define SPLITFUSION_BUILD \
  "splitfusion " SPLITFUSION_VERSION " (" SPLITFUSION_METHOD_HASH        \
  "), compiler " __VERSION__ " (ABI " SPLITFUSION_TEXT(                  \
      _GLIBCXX_USE_CXX11_ABI) "), Eigen " SPLITFUSION_TEXT(              \
      EIGEN_WORLD_VERSION) "." SPLITFUSION_TEXT(EIGEN_MAJOR_VERSION) "." \
  SPLITFUSION_TEXT(EIGEN_MINOR_VERSION) " (alignment " SPLITFUSION_TEXT( \
      EIGEN_MAX_ALIGN_BYTES) ")"

/// Makes a shared library of energy terms, for sf_run --terms_library. `add`: a
/// function void(splitfusion::TermRegistry*) that registers them. Stands once
/// in the library, outside of any namespace.
#define SPLITFUSION_TERMS_LIBRARY(add)                                        \
  extern "C" __attribute__((visibility("default")))                           \
  const char SplitFusionTermsBuild[] = SPLITFUSION_BUILD;                     \
  extern "C" __attribute__((visibility("default"))) void SplitFusionAddTerms( \
      ::splitfusion::TermRegistry* terms) {                                   \
    add(terms);                                                               \
  }

namespace splitfusion {

/// Loads a shared library of terms, for the rest of the program, and registers
/// them; each is made once to see that it can be. Nothing in it is called
/// unless its SPLITFUSION_BUILD is that of the program, but for what runs when
/// it is loaded.
///
/// @throw InputError if the file is cut off or cannot be loaded, is no such
///     library, was built with something else, adds no term, one of a name that
///     is taken or one that is refused by MakeTerm(), removes any, or throws.
///     `terms` are then what they were.
void LoadTermsLibrary(const std::string& path, TermRegistry* terms);

/// The same of several, FILE,FILE,...; returns their paths. Empty text: none.
///
/// @throw InputError as of one.
std::vector<std::string> LoadTermsLibraries(const std::string& list,
                                            TermRegistry* terms);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TERMS_LIBRARY_H_
