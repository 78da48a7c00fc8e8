// Runs sf_run and sf_evaluate over sequences and options, and tabulates them.

#include <gflags/gflags.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "batch_terminal.h"
#include "interruption.h"
#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/make_folder.h"
#include "splitfusion/lib/experiment/foreign_results.h"
#include "splitfusion/lib/experiment/outdated_runs.h"
#include "splitfusion/lib/experiment/printed_table.h"
#include "splitfusion/lib/experiment/result_files.h"
#include "splitfusion/lib/experiment/result_statistics.h"
#include "splitfusion/lib/experiment/result_table.h"
#include "splitfusion/lib/experiment/row_file.h"
#include "splitfusion/lib/experiment/sequence_list.h"
#include "splitfusion/lib/experiment/slurm_array.h"
#include "splitfusion/lib/experiment/sweep.h"
#include "splitfusion/lib/experiment/sweep_page.h"
#include "splitfusion/lib/experiment/task_list.h"
#include "tool_main.h"

DEFINE_string(sequences, "", "Folders or list files (one folder a line).");
DEFINE_string(grid, "", "What varies: \"KEY=V,V; KEY=V,V\".");
DEFINE_string(set, "", "Options of all runs: \"KEY=V; KEY=V\".");
DEFINE_int32(repeat, 0, "Runs of each, voxels changed by millionths; 0 = 1.");
DEFINE_string(experiment, "", "JSON file with all of these settings.");
DEFINE_string(rows, "", "Only these rows of --experiment, by name.");
DEFINE_string(output, "", "Folder of the experiment.");
DEFINE_int32(random, 0, "Random points of --grid with lo..hi, log:lo..hi.");
DEFINE_int32(seed, 1, "Seed of --random.");
DEFINE_string(ground_truth, "auto",
              "auto (beside the sequence), none, or a folder.");
DEFINE_string(evaluate, "", "Flags of sf_evaluate: \"KEY=V; KEY=V\".");
DEFINE_int32(jobs, 1, "Runs at the same time.");
DEFINE_int32(threads, 0, "Threads of each run; 0 = cores / jobs.");
DEFINE_double(max_wall_minutes, 0, "A longer run is killed; 0 = no limit.");
DEFINE_double(max_cpu_minutes, 0,
              "A run with more CPU time is killed; 0 = no limit.");
DEFINE_double(max_memory_gb, 0, "A run with more memory is killed; 1e9 bytes.");
DEFINE_bool(fail_fast, false, "Start nothing after a failure.");
DEFINE_bool(keep_failed, false, "Do not try failed runs again.");
DEFINE_bool(overwrite, false, "Repeat finished runs.");
DEFINE_bool(dry_run, false, "Print what would be run, and why.");
DEFINE_string(rows_csv, "", "File of finished rows, read and added to.");
DEFINE_string(baseline, "",
              "Row, or \"KEY=V\", that others are compared with.");
DEFINE_string(foreign, "",
              "Others' \"NAME:SEQUENCE=TRAJECTORY[,MESH.ply]; ...\"");
DEFINE_string(run_program, "", "Another sf_run than the one beside sf_batch.");
DEFINE_string(evaluate_program, "",
              "Another sf_evaluate than the one beside it.");
DEFINE_int32(slurm_max_array, 1001, "MaxArraySize, of emit-slurm.");
DEFINE_string(task_list, "", "List of emit-slurm, of which --task is run.");
DEFINE_int32(task, 0, "Line of --task_list.");

namespace splitfusion {
namespace {

constexpr char kUsage[] =
    "Runs many sequences with many options, and tabulates them.\n"
    "  sf_batch run --sequences=DIR,DIR --output=DIR\n"
    "               [--grid=\"terms.arap.weight=4,8\"] [--repeat=N] "
    "[--jobs=N]\n"
    "  sf_batch status --output=DIR     what is done, what failed\n"
    "  sf_batch collect --output=DIR    tables: results.csv, results.sqlite\n"
    "  sf_batch emit-slurm --output=DIR [...] | sh    the same by Slurm\n"
    "KEY: a flag of sf_run, or [CLASS.]terms.NAME.KEY. A value V with , or ;\n"
    "in double quotes. See docs/experiments.md, docs/cluster.md.\n";

/// A program beside this one, unless a flag names another.
std::string Program(const std::string& flag, const std::string& name) {
  if (!flag.empty()) return flag;
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / name)
      .string();
}

int Cores() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Leaves the rows that --rows names.
void SelectRows(Experiment* experiment) {
  const std::vector<std::string> names = SplitOutsideQuotes(FLAGS_rows, ',');
  if (names.empty()) return;
  std::vector<NamedSettings> selected;
  for (const std::string& name : names) {
    const auto found = std::find_if(
        experiment->rows.begin(), experiment->rows.end(),
        [&](const NamedSettings& row) { return row.name == name; });
    CheckOption(found != experiment->rows.end(), "rows", name,
                "a row of --experiment");
    selected.push_back(*found);
  }
  experiment->rows = selected;
}

/// The experiment of --experiment, with what the other flags add to it.
Experiment ExperimentFromFlags() {
  Experiment experiment;
  if (!FLAGS_experiment.empty()) experiment = ReadExperiment(FLAGS_experiment);
  if (!FLAGS_sequences.empty()) {
    experiment.sequences = ReadSequences(FLAGS_sequences, FLAGS_ground_truth);
  }
  experiment.set.SetAll(ParseSettings(FLAGS_set, "set"));
  for (const Axis& axis : ParseGrid(FLAGS_grid, "grid")) {
    const auto same =
        std::find_if(experiment.grid.begin(), experiment.grid.end(),
                     [&](const Axis& other) { return other.key == axis.key; });
    if (same == experiment.grid.end()) {
      experiment.grid.push_back(axis);
    } else {
      *same = axis;
    }
  }
  if (FLAGS_random != 0) {
    experiment.random = FLAGS_random;
    experiment.seed = static_cast<std::uint64_t>(FLAGS_seed);
  }
  if (FLAGS_repeat != 0) experiment.repeat = FLAGS_repeat;
  SelectRows(&experiment);
  if (!FLAGS_baseline.empty()) experiment.baseline = FLAGS_baseline;
  experiment.evaluate.SetAll(ParseSettings(FLAGS_evaluate, "evaluate"));
  return experiment;
}

SweepOptions SweepOptionsFromFlags(const Experiment& experiment) {
  constexpr double kMinute = 60, kGigabyte = 1e9;
  SweepOptions options;
  options.run_program = Program(FLAGS_run_program, "sf_run");
  options.output = FLAGS_output;
  options.jobs = FLAGS_jobs;
  options.threads = FLAGS_threads;
  if (FLAGS_threads == 0) {
    options.threads = std::max(1, Cores() / std::max(1, FLAGS_jobs));
  }
  for (const Axis& axis : experiment.grid) {
    if (axis.key == "threads") options.threads = 0;
  }
  options.fail_fast = FLAGS_fail_fast;
  options.row_file = FLAGS_rows_csv;
  options.runner.evaluate_program =
      Program(FLAGS_evaluate_program, "sf_evaluate");
  options.runner.limits.wall_seconds = FLAGS_max_wall_minutes * kMinute;
  options.runner.limits.cpu_seconds = FLAGS_max_cpu_minutes * kMinute;
  options.runner.limits.memory_bytes =
      static_cast<std::int64_t>(FLAGS_max_memory_gb * kGigabyte);
  options.runner.overwrite = FLAGS_overwrite;
  options.runner.keep_failed = FLAGS_keep_failed;
  options.Check();
  return options;
}

Stop WantedStop() {
  if (InterruptedTwice()) return Stop::kAtOnce;
  return Interrupted() ? Stop::kWhenReady : Stop::kNo;
}

/// Whether there are outdated runs.
bool WarnOfOutdated(const ResultTable& table) {
  const std::string text = OutdatedText(table);
  if (!text.empty()) std::cerr << "sf_batch: warning: " << text << '\n';
  return !text.empty();
}

void AddRows(const ResultTable& table) {
  if (FLAGS_rows_csv.empty()) return;
  AddToRowFile(table, FLAGS_rows_csv);
}

/// A file that cannot be written is better found before the runs than after.
void CheckRowFile() {
  if (FLAGS_rows_csv.empty()) return;
  if (!std::filesystem::exists(FLAGS_rows_csv)) {
    std::cerr << "sf_batch: " << FLAGS_rows_csv << ": is a new file\n";
  }
  RowFile(FLAGS_rows_csv).Write(FLAGS_rows_csv);
}

/// Writes all tables and prints them. False if runs had to be left out that
/// must not stand beside the others.
bool Collect(const std::string& baseline_flag) {
  const ExperimentFolder folder(FLAGS_output);
  const ResultTable table = CollectResults(folder);
  std::string baseline = baseline_flag;
  if (baseline.empty()) baseline = KnownBaseline(folder);
  if (!baseline.empty()) CheckBaseline(table, baseline);
  AddRows(table);
  const std::vector<ResultGroup> groups = GroupResults(table);
  std::vector<FileTable> files = {ResultsTable(table),
                                  SummaryTable(table, groups)};
  WriteCsv(folder.Below("results.csv"), files[0]);
  WriteCsv(folder.Below("summary.csv"), files[1]);
  std::cout << PrintedSummary(table, groups, TerminalWidth());
  if (!baseline.empty()) {
    const auto differences = CompareWithBaseline(table, baseline);
    files.push_back(DifferencesTable(table, differences));
    files.push_back(EffectsTable(table, differences));
    WriteCsv(folder.Below("differences.csv"), files[2]);
    WriteCsv(folder.Below("effects.csv"), files[3]);
    std::cout << '\n'
              << PrintedDifferences(table, differences, baseline,
                                    TerminalWidth());
  }
  WriteSqlite(folder.Below("results.sqlite"), files);
  const std::string page =
      SweepPage(folder, table, groups, {files.begin() + 1, files.end()});
  WriteFileAtomically(folder.Below("report.html"),
                      [&](std::ostream& out) { out << page; });
  return !WarnOfOutdated(table);
}

int PrintDryRun(const Experiment& experiment, const SweepOptions& options) {
  std::map<std::string, int> counts;
  for (const auto& [task, what] : DryRun(experiment, options)) {
    const std::string settings = SettingsText(task.settings);
    std::cout << task.name << "  " << what
              << (task.row.empty() ? "" : "  " + task.row)
              << (settings.empty() ? "" : "  " + settings) << '\n';
    ++counts[what.substr(0, what.find(':'))];
  }
  std::string text;
  for (const auto& [what, count] : counts) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  }
  std::cout << text << '\n';
  return kExitDone;
}

/// What only the tables need is checked before the first run, too.
void CheckTables(const Experiment& experiment,
                 const std::vector<ForeignResult>& foreign) {
  const ExperimentFolder folder(FLAGS_output);
  std::vector<Task> tasks = PlanTasks(experiment);
  if (IsExperiment(folder)) {
    for (const Task& task : KnownTasks(folder)) tasks.push_back(task);
  }
  for (const Task& task : PlanForeign(tasks, foreign)) tasks.push_back(task);
  if (!FLAGS_rows_csv.empty()) RowFile{FLAGS_rows_csv};
  if (experiment.baseline.empty()) return;
  try {
    CheckBaseline(PlannedTable(tasks), experiment.baseline);
  } catch (const InputError& error) {
    if (!FLAGS_baseline.empty()) throw;
    throw InputError(FLAGS_experiment + ": " + error.what());
  }
}

/// Refuses flags that would have no effect.
void RefuseFlags(const std::string& where,
                 std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const auto flag = gflags::GetCommandLineFlagInfoOrDie(name);
    CheckOption(flag.is_default, name, flag.current_value,
                "no such flag with " + where);
  }
}

/// Runs tasks, and says how far it is.
SweepOutcome ShowRuns(
    const std::function<SweepOutcome(const SweepCallback&)>& run) {
  ProgressLines lines;
  const SweepOutcome outcome =
      run([&](const SweepProgress& progress) { lines.Show(progress); });
  lines.End();
  return outcome;
}

/// @throw std::runtime_error if the runs were interrupted.
int ExitCodeOf(const SweepOutcome& outcome, bool stopped) {
  if (stopped) {
    throw std::runtime_error(
        "interrupted after " + std::to_string(outcome.ended) + " of " +
        std::to_string(outcome.planned) +
        " runs; the same command goes on with the experiment");
  }
  if (outcome.failed == 0) return kExitDone;
  std::cerr << outcome.failed << " of " << outcome.planned
            << " runs failed; see sf_batch status --output=" << FLAGS_output
            << '\n';
  return kExitFailedRuns;
}

int RunExperiment() {
  RefuseFlags("run without --task_list", {"task"});
  const Experiment experiment = ExperimentFromFlags();
  SweepOptions options = SweepOptionsFromFlags(experiment);
  const std::vector<ForeignResult> foreign = ParseForeignResults(FLAGS_foreign);
  CheckTables(experiment, foreign);
  if (FLAGS_dry_run) return PrintDryRun(experiment, options);
  if (options.jobs * std::max(1, options.threads) > Cores()) {
    std::cerr << "sf_batch: warning: " << options.jobs << " jobs x "
              << options.threads << " threads on " << Cores() << " cores\n";
  }
  // Until then a signal just ends the program.
  options.planned = [] {
    CheckRowFile();
    CatchInterruption(SecondSignal::kIsTold);
  };
  const SweepOutcome outcome = ShowRuns([&](const SweepCallback& progress) {
    return RunSweep(experiment, options, progress, WantedStop);
  });
  const bool stopped = Interrupted() && outcome.ended < outcome.planned;
  AddForeignResults(ExperimentFolder(FLAGS_output), foreign);
  Collect(experiment.baseline);
  return ExitCodeOf(outcome, stopped);
}

/// What decides which tasks there are.
constexpr std::initializer_list<const char*> kExperimentFlags = {
    "sequences", "grid", "set",          "repeat",   "experiment", "rows",
    "random",    "seed", "ground_truth", "evaluate", "baseline"};

/// Runs one task of a list. Tables are left to `collect`: many do so at once.
int RunListedTask() {
  RefuseFlags("--task_list", kExperimentFlags);
  RefuseFlags("--task_list", {"foreign", "rows_csv", "dry_run"});
  const std::vector<Task> tasks = {ReadTaskOfList(FLAGS_task_list, FLAGS_task)};
  SweepOptions options = SweepOptionsFromFlags(Experiment());
  options.planned = [] { CatchInterruption(SecondSignal::kIsTold); };
  const SweepOutcome outcome = ShowRuns([&](const SweepCallback& progress) {
    return RunTasks(tasks, options, progress, WantedStop);
  });
  return ExitCodeOf(outcome, Interrupted() && outcome.ended == 0);
}

/// Whether the flags name an experiment; emit-slurm takes those of the folder
/// otherwise.
bool NameExperiment() {
  return std::any_of(
      kExperimentFlags.begin(), kExperimentFlags.end(), [](const char* name) {
        return !gflags::GetCommandLineFlagInfoOrDie(name).is_default;
      });
}

int EmitSlurm() {
  RefuseFlags("emit-slurm", {"jobs", "fail_fast", "overwrite", "dry_run",
                             "rows_csv", "foreign", "task_list", "task"});
  SlurmArray array;
  array.max_array = FLAGS_slurm_max_array;
  array.Check();
  const ExperimentFolder folder(FLAGS_output);
  const bool adds = NameExperiment();
  const Experiment experiment = adds ? ExperimentFromFlags() : Experiment();
  SweepOptions options = SweepOptionsFromFlags(experiment);
  // The cores of this machine tell nothing of those of the nodes.
  options.threads = std::max(1, FLAGS_threads);
  if (adds) CheckTables(experiment, {});
  const std::vector<Task> tasks = UnfinishedTasks(
      DryRun(adds ? PlanTasks(experiment) : KnownTasks(folder), options),
      FLAGS_keep_failed);
  if (adds) {
    MakeFolder(FLAGS_output);
    AddExperiment(folder, experiment);
  }
  if (tasks.empty()) std::cerr << "sf_batch: all runs are finished\n";
  array = MakeSlurmArray(tasks, options, Program("", "sf_batch"),
                         WriteTaskList(folder.Below("slurm"), tasks));
  array.max_array = FLAGS_slurm_max_array;
  std::cout << SlurmScript(array);
  return kExitDone;
}

int PrintStatus() {
  const ResultTable table = CollectResults(ExperimentFolder(FLAGS_output));
  std::map<std::string, int> counts;
  for (const ResultRow& row : table.rows) {
    ++counts[row.status.substr(0, row.status.find(':'))];
  }
  std::cout << table.rows.size() << " runs";
  for (const auto& [status, count] : counts) {
    std::cout << ", " << count << ' ' << status;
  }
  std::cout << '\n';
  for (const ResultRow& row : table.rows) {
    if (row.IsComplete() || row.status == "waiting") continue;
    std::cout << row.task.name << "  " << row.status
              << (row.error.empty() ? "" : ": " + row.error) << '\n';
  }
  WarnOfOutdated(table);
  return kExitDone;
}

int CollectAll() {
  CheckRowFile();
  AddForeignResults(ExperimentFolder(FLAGS_output),
                    ParseForeignResults(FLAGS_foreign));
  return Collect(FLAGS_baseline) ? kExitDone : kExitFailedRuns;
}

int Execute(const std::string& command) {
  CheckOption(!FLAGS_output.empty(), "output", "''",
              "the folder of the experiment");
  if (command == "run") {
    return FLAGS_task_list.empty() ? RunExperiment() : RunListedTask();
  }
  if (command == "emit-slurm") return EmitSlurm();
  if (command == "status") return PrintStatus();
  if (command == "collect") return CollectAll();
  throw InputError(
      "command '" + command +
      "': expected run, status, collect or emit-slurm, see --help");
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  std::string command;
  std::vector<char*> rest(argv, argv + argc);
  if (argc > 1 && argv[1][0] != '-') {
    command = argv[1];
    rest.erase(rest.begin() + 1);
  }
  rest.push_back(nullptr);
  return splitfusion::ToolMain(
      static_cast<int>(rest.size()) - 1, rest.data(), splitfusion::kUsage,
      [&command] { return splitfusion::Execute(command); });
}
