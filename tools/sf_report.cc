// Writes one page about finished runs.

#include <gflags/gflags.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/page/html_report.h"
#include "splitfusion/lib/page/svg_chart.h"
#include "tool_main.h"

DEFINE_string(output, "", "Page to write, FILE.html.");
DEFINE_string(figures, "", "Folder for the curves, one SVG file each.");
DEFINE_string(media, "auto",
              "Pictures, surfaces in 3D: auto (of one run alone), all, none.");

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr char kUsage[] =
    "Writes one self-contained page about runs that have ended: summary,\n"
    "evaluation, options, curves over the frames, states and pictures; of "
    "several\nruns a table that compares them.\n"
    "  sf_report RUN... --output=FILE.html [--figures=DIR]\n";

/// The curves of a run as files: RUN_seconds.svg, RUN_NNN_LABEL_cost.svg, ...
int WriteFigures(const ReportedRun& run, const fs::path& folder) {
  int written = 0;
  std::string prefix = run.name;
  std::replace(prefix.begin(), prefix.end(), '/', '_');
  const auto write = [&](const std::string& name, const CurveGroup& group) {
    const std::string svg = SvgFile(SvgChart(
        {group.title, group.series, {}, group.stacked, run.curves.frames}));
    WriteFileAtomically((folder / (prefix + "_" + name + ".svg")).string(),
                        [&](std::ostream& out) { out << svg; });
    ++written;
  };
  write("seconds", run.curves.seconds);
  for (const SurfaceCurves& surface : run.curves.surfaces) {
    for (const CurveGroup& group : surface.groups) {
      write(surface.name + "_" + group.name, group);
    }
  }
  return written;
}

/// The runs, by the names of their folders; by their whole paths if two have
/// the same.
std::vector<ReportedRun> ReadRuns(const std::vector<std::string>& folders) {
  std::vector<ReportedRun> runs;
  std::set<std::string> names;
  for (const std::string& folder : folders) {
    // Without a slash at the end a folder has a name.
    const fs::path path = (fs::path(folder) / "").parent_path();
    runs.push_back(ReadReportedRun(RunPaths(path.string())));
    names.insert(runs.back().name);
  }
  if (names.size() == runs.size()) return runs;
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].name = folders[i];
  return runs;
}

int Run(const std::vector<std::string>& folders) {
  CheckOption(!folders.empty(), "RUN", folders.size(),
              "one run directory or more");
  CheckOption(!FLAGS_output.empty() || !FLAGS_figures.empty(), "output", "''",
              "a file to write, or --figures");
  CheckOption(
      FLAGS_media == "auto" || FLAGS_media == "all" || FLAGS_media == "none",
      "media", FLAGS_media, "auto, all or none");
  const std::vector<ReportedRun> runs = ReadRuns(folders);
  if (!FLAGS_output.empty()) {
    const bool media =
        FLAGS_media == "auto" ? runs.size() == 1 : FLAGS_media == "all";
    const std::string page = HtmlReport(runs, {media, media});
    WriteFileAtomically(FLAGS_output, [&](std::ostream& out) { out << page; });
    std::cout << FLAGS_output << ": " << runs.size()
              << (runs.size() == 1 ? " run\n" : " runs\n");
  }
  if (!FLAGS_figures.empty()) {
    fs::create_directories(FLAGS_figures);
    int written = 0;
    for (const ReportedRun& run : runs) {
      written += WriteFigures(run, FLAGS_figures);
    }
    std::cout << FLAGS_figures << ": " << written << " figures\n";
  }
  return kExitDone;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  std::vector<std::string> arguments;
  return splitfusion::ToolMain(
      argc, argv, splitfusion::kUsage,
      [&] { return splitfusion::Run(arguments); }, "", &arguments);
}
