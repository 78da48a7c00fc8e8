// A shared library with one energy term:
//   sf_run --terms_library=libstretch.so --set="terms.stretch.weight=4" ...

#include "stretch_term.h"

#include <memory>

#include "splitfusion/lib/energy/terms_library.h"

namespace {

void AddTerms(splitfusion::TermRegistry* terms) {
  terms->Register("stretch", [] { return std::make_unique<StretchTerm>(); });
}

}  // namespace

SPLITFUSION_TERMS_LIBRARY(AddTerms)
