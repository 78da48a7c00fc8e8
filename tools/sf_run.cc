// Runs SplitFusion on one RGB-D sequence and writes a run directory.

#include "sf_run_main.h"

int main(int argc, char** argv) {
  return splitfusion::SfRunMain(argc, argv, splitfusion::Registries());
}
