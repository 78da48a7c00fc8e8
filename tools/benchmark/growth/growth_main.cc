// Measures growth curves and writes one CSV file each: x, series, seconds and
// perhaps more. Exit code 2 if an argument is wrong. ../growth.sh draws them.

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <string>

#include "growth_curves.h"
#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/freed_memory.h"
#include "splitfusion/lib/base/stopwatch.h"

namespace splitfusion {

GrowthSizes GrowthSizes::Quick() {
  GrowthSizes sizes;
  sizes.nodes = {25, 64};
  sizes.points = {500, 1000};
  sizes.fixed_nodes = 25;
  sizes.voxels = {0.03, 0.02};
  sizes.people = {0, 1};
  sizes.frames = 2;
  sizes.height = sizes.run_height = 120;
  sizes.spacing = 0.1;
  sizes.voxel_factor = 4;
  sizes.repetitions = sizes.runs = 1;
  return sizes;
}

namespace {

namespace fs = std::filesystem;

/// A curve by the name of its file.
using Curves = std::map<std::string, std::function<GrowthTable(GrowthSizes)>>;

Curves AllCurves() {
  return {{"nodes", NodesCurve},
          {"correspondences", CorrespondencesCurve},
          {"voxels", VoxelsCurve},
          {"people", PeopleCurve},
          {"one_graph", OneGraphTable}};
}

/// What the command line asks for.
struct Arguments {
  std::string output;
  GrowthSizes sizes;
  Curves curves = AllCurves();
};

std::string Known(const Curves& curves) {
  std::string names;
  for (const auto& [name, curve] : curves) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

void SelectCurve(const std::string& name, Curves* curves) {
  const auto found = curves->find(name);
  CheckOption(found != curves->end(), "--curve", name, Known(*curves));
  *curves = Curves{*found};
}

Arguments ParseArguments(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    const std::string value =
        text.substr(std::min(text.size(), text.find('=')));
    if (text == "--quick") {
      arguments.sizes = GrowthSizes::Quick();
    } else if (text.rfind("--output=", 0) == 0) {
      arguments.output = value.substr(1);
    } else if (text.rfind("--curve=", 0) == 0) {
      SelectCurve(value.substr(1), &arguments.curves);
    } else {
      throw InputError(text +
                       ": unknown argument: expected --output=DIR, "
                       "--curve=NAME or --quick");
    }
  }
  if (arguments.output.empty()) throw InputError("expected --output=DIR");
  return arguments;
}

/// Makes the folder; says so before anything is run if nothing can be written
/// there.
void PrepareFolder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!CanMakeFiles(folder)) {
    throw InputError("--output=" + folder + ": cannot be written");
  }
}

void Run(const Arguments& arguments) {
  PrepareFolder(arguments.output);
  for (const auto& [name, curve] : arguments.curves) {
    const Stopwatch stopwatch;
    const std::string path = arguments.output + "/" + name + ".csv";
    curve(arguments.sizes).Write(path);
    std::cout << path << ": " << stopwatch.Seconds() << " s" << std::endl;
  }
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  splitfusion::KeepFreedMemory();
  try {
    splitfusion::Run(splitfusion::ParseArguments(argc, argv));
    return 0;
  } catch (const splitfusion::InputError& error) {
    std::cerr << "sf_growth: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "sf_growth: " << error.what() << '\n';
    return 1;
  }
}
