// Writes one page about finished runs.

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/make_folder.h"
#include "splitfusion/lib/experiment/child_process.h"
#include "splitfusion/lib/experiment/scratch_folder.h"
#include "splitfusion/lib/page/html_report.h"
#include "splitfusion/lib/page/svg_chart.h"
#include "tool_main.h"

DEFINE_string(output, "", "Page to write, FILE.html.");
DEFINE_string(figures, "", "Folder for the curves, one file each.");
DEFINE_string(figure_format, "svg", "Of --figures: svg, or pdf as well.");
DEFINE_string(media, "auto",
              "Pictures, surfaces in 3D: auto (of one run alone), all, none.");

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr char kUsage[] =
    "Writes one self-contained page about runs that have ended: summary,\n"
    "evaluation, options, surfaces in 3D, curves over the frames, states and\n"
    "pictures; of several runs a table and curves that compare them. A folder\n"
    "of sf_solve adds its profiles.\n"
    "  sf_report RUN... --output=FILE.html [--figures=DIR]\n";

/// Makes PATH.pdf of PATH.svg.
void WritePdf(const std::string& path) {
  WritePathAtomically(path + ".pdf", [&](const std::string& temporary) {
    const ScratchFolder scratch;
    const ChildResult result =
        RunChild({"/usr/bin/env", "rsvg-convert", "--format=pdf",
                  "--output=" + temporary, path + ".svg"},
                 scratch.path() + "/rsvg-convert");
    if (result.exit_code == 0) return;
    throw InputError(
        result.exit_code == 127
            ? "--figure_format=pdf: rsvg-convert not found: expected Debian's "
              "librsvg2-bin"
            : "--figure_format=pdf: rsvg-convert: " + result.LastLine());
  });
}

/// The curves of a run as files: RUN_seconds.svg, RUN_NNN_LABEL_cost.svg, ...
int WriteFigures(const ReportedRun& run, const fs::path& folder) {
  int written = 0;
  std::string prefix = run.name;
  std::replace(prefix.begin(), prefix.end(), '/', '_');
  const auto write = [&](const std::string& name, const CurveGroup& group) {
    const std::string svg = SvgFile(SvgChart(
        {group.title, group.series, {}, group.stacked, run.curves.frames}));
    const std::string path = (folder / (prefix + "_" + name)).string();
    WriteFileAtomically(path + ".svg", [&](std::ostream& out) { out << svg; });
    if (FLAGS_figure_format == "pdf") WritePdf(path);
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

/// Paths without the folders that all of them begin and end with.
std::vector<std::string> ShortNames(const std::vector<fs::path>& paths) {
  std::vector<std::vector<std::string>> parts;
  for (const fs::path& path : paths) {
    const fs::path whole = fs::absolute(path).lexically_normal();
    parts.emplace_back(whole.begin(), whole.end());
  }
  // Whether all agree in the part that `at` takes, and have others.
  const auto agree = [&](const auto& at) {
    return std::all_of(parts.begin(), parts.end(), [&](const auto& one) {
      return one.size() > 1 && at(one) == at(parts.front());
    });
  };
  while (agree([](const auto& one) { return one.front(); })) {
    for (auto& one : parts) one.erase(one.begin());
  }
  while (agree([](const auto& one) { return one.back(); })) {
    for (auto& one : parts) one.pop_back();
  }
  std::vector<std::string> names;
  for (const auto& one : parts) {
    fs::path name;
    for (const std::string& part : one) name /= part;
    names.push_back(name.string());
  }
  return names;
}

/// The runs, by the names of their folders; if two have the same, by what tells
/// their paths apart.
std::vector<ReportedRun> ReadRuns(const std::vector<std::string>& folders) {
  std::vector<ReportedRun> runs;
  std::vector<fs::path> paths;
  std::set<std::string> names;
  for (const std::string& folder : folders) {
    // Without a slash at the end a folder has a name.
    paths.push_back(
        (fs::absolute(folder) / "").lexically_normal().parent_path());
    runs.push_back(ReadReportedRun(RunPaths(paths.back().string())));
    names.insert(runs.back().name);
  }
  if (names.size() == runs.size()) return runs;
  const std::vector<std::string> apart = ShortNames(paths);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].name = apart[i];
    CheckOption(std::count(paths.begin(), paths.end(), paths[i]) == 1, "RUN",
                folders[i], "every run once");
  }
  return runs;
}

void WritePage(const std::vector<ReportedRun>& runs,
               const std::vector<std::string>& solver_folders) {
  std::vector<ReportedSolvers> solvers;
  for (const std::string& folder : solver_folders) {
    solvers.push_back(ReadReportedSolvers(folder));
  }
  const bool media =
      FLAGS_media == "auto" ? runs.size() == 1 : FLAGS_media == "all";
  std::vector<std::string> left_out;
  const std::string page = HtmlReport(runs, {media, media}, solvers, &left_out);
  for (const std::string& line : left_out) {
    LOG(WARNING) << line << ": its surfaces are left out";
  }
  WriteFileAtomically(FLAGS_output, [&](std::ostream& out) { out << page; });
  std::cout << FLAGS_output << ": " << runs.size()
            << (runs.size() == 1 ? " run\n" : " runs\n");
}

int Run(std::vector<std::string> folders) {
  CheckOption(!folders.empty(), "RUN", folders.size(),
              "one run directory or more");
  CheckOption(!FLAGS_output.empty() || !FLAGS_figures.empty(), "output", "''",
              "a file to write, or --figures");
  CheckOption(FLAGS_figure_format == "svg" || FLAGS_figure_format == "pdf",
              "figure_format", FLAGS_figure_format, "svg or pdf");
  CheckOption(
      FLAGS_media == "auto" || FLAGS_media == "all" || FLAGS_media == "none",
      "media", FLAGS_media, "auto, all or none");
  const auto solved =
      std::stable_partition(folders.begin(), folders.end(),
                            [](const auto& one) { return !IsOfSolvers(one); });
  const std::vector<ReportedRun> runs = ReadRuns({folders.begin(), solved});
  if (!FLAGS_output.empty()) {
    CheckIsNoFileOfARun(FLAGS_output);
    WritePage(runs, {solved, folders.end()});
  }
  if (!FLAGS_figures.empty()) {
    MakeFolder(FLAGS_figures);
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
