// sf_run with a term more:
//   sf_run_stretch --set="terms.stretch.weight=4" ...

#include <memory>

#include "splitfusion/tools/sf_run_main.h"
#include "stretch_term.h"

int main(int argc, char** argv) {
  splitfusion::Registries registries;
  registries.terms.Register("stretch",
                            [] { return std::make_unique<StretchTerm>(); });
  return splitfusion::SfRunMain(argc, argv, registries);
}
