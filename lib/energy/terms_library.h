#ifndef SPLITFUSION_LIB_ENERGY_TERMS_LIBRARY_H_
#define SPLITFUSION_LIB_ENERGY_TERMS_LIBRARY_H_

#include <string>

#include "splitfusion/lib/energy/term_registry.h"
#include "splitfusion/method_hash.h"

namespace splitfusion {

/// What a program and a library of terms must have been built with alike, or
/// they would read each other's memory wrongly.
#define SPLITFUSION_BUILD                                         \
  "splitfusion " SPLITFUSION_VERSION " (" SPLITFUSION_METHOD_HASH \
  "), compiler " __VERSION__

/// How a shared library presents its terms; in it a program reads `build`
/// alone, until it knows that they fit.
struct TermsLibrary {
  const char* build;                 ///< SPLITFUSION_BUILD, there.
  void (*add)(TermRegistry* terms);  ///< Registers its terms.
};

/// Makes a shared library of energy terms, for sf_run --terms_library. `add`: a
/// function void(splitfusion::TermRegistry*) that registers them. Stands once
/// in the library, outside of any namespace.
#define SPLITFUSION_TERMS_LIBRARY(add)                        \
  extern "C" ::splitfusion::TermsLibrary SplitFusionTerms() { \
    return {SPLITFUSION_BUILD, add};                          \
  }

/// Loads a shared library of terms, for the rest of the program, and registers
/// them.
///
/// @throw InputError if the file cannot be loaded, is no such library, was
///     built with another version or compiler, or has a term of a name that is
///     taken.
void LoadTermsLibrary(const std::string& path, TermRegistry* terms);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TERMS_LIBRARY_H_
