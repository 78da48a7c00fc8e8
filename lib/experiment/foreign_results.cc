#include "splitfusion/lib/experiment/foreign_results.h"

#include <filesystem>
#include <set>
#include <utility>

#include "splitfusion/lib/base/directory_lock.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/make_folder.h"
#include "splitfusion/lib/evaluation/ghosts.h"
#include "splitfusion/lib/evaluation/ground_truth.h"
#include "splitfusion/lib/evaluation/headline.h"
#include "splitfusion/lib/evaluation/run_evaluation.h"
#include "splitfusion/lib/evaluation/surface_error.h"
#include "splitfusion/lib/evaluation/trajectory_error.h"
#include "splitfusion/lib/experiment/task_record.h"

namespace splitfusion {
namespace {

/// Share of the background's vertices that are far from the true scene.
double GhostShare(const std::string& background, const GroundTruth& truth,
                  const Rigid3d& truth_from_estimate) {
  if (truth.static_mesh.empty()) {
    throw InputError(background + ": cannot be judged: no static_mesh.ply in " +
                     truth.folder);
  }
  TriangleMesh mesh = ReadPly(background);
  if (mesh.empty()) throw InputError(background + ": no vertex");
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex = (truth_from_estimate * vertex.cast<double>()).cast<float>();
  }
  return CountGhosts(mesh, ReadTrueSurface(truth.static_mesh).mesh).Share();
}

Figures EvaluateForeign(const ForeignResult& result,
                        const std::string& ground_truth) {
  const GroundTruth truth = ReadGroundTruth(ground_truth);
  const Trajectory estimate = ReadTumTrajectory(result.trajectory);
  if (estimate.empty()) throw InputError(result.trajectory + ": no pose");
  RunEvaluation evaluation;
  evaluation.trajectory = CompareTrajectories(estimate, truth.trajectory);
  const Headline headline = HeadlineOf(evaluation);
  Figures figures;
  figures.At("frames") = static_cast<double>(estimate.size());
  for (const HeadlineFigure& figure : kHeadlineFigures) {
    const auto& value = headline.*figure.value;
    if (value) figures.At(figure.name) = *value;
  }
  if (!result.background.empty()) {
    figures.At("ghosts") =
        GhostShare(result.background, truth,
                   evaluation.trajectory->truth_from_estimate_by_poses);
  }
  return figures;
}

/// A task of the sequence, for its ground truth.
Task FindTask(const std::vector<Task>& tasks, const ForeignResult& result) {
  for (const Task& task : tasks) {
    if (task.sequence == result.sequence && !task.ground_truth.empty()) {
      return task;
    }
  }
  throw InputError("foreign = " + result.system + ":" + result.sequence +
                   ": expected a sequence of this experiment that has a "
                   "ground truth");
}

/// NAME:SEQUENCE=TRAJECTORY[,BACKGROUND]
ForeignResult ParseOne(const std::string& entry) {
  const std::size_t equal = entry.find('=');
  const std::size_t colon = entry.substr(0, equal).find(':');
  std::vector<std::string> files;
  if (equal != std::string::npos) {
    files = SplitOutsideQuotes(entry.substr(equal + 1), ',');
  }
  const bool good = colon != std::string::npos && colon > 0 &&
                    colon + 1 < equal && !files.empty() && files.size() < 3;
  CheckOption(good, "foreign", "'" + entry + "'",
              "NAME:SEQUENCE=TRAJECTORY[,BACKGROUND.ply]; ...");
  return {entry.substr(0, colon), entry.substr(colon + 1, equal - colon - 1),
          Unquoted(files[0]), files.size() > 1 ? Unquoted(files[1]) : ""};
}

}  // namespace

std::vector<ForeignResult> ParseForeignResults(const std::string& text) {
  std::vector<ForeignResult> results;
  std::set<std::pair<std::string, std::string>> known;
  for (const std::string& entry : SplitOutsideQuotes(text, ';')) {
    const ForeignResult result = ParseOne(entry);
    CheckOption(known.emplace(result.system, result.sequence).second, "foreign",
                "'" + entry + "'",
                "one result of a system on a sequence; others under other "
                "names");
    results.push_back(result);
  }
  return results;
}

std::vector<Task> PlanForeign(const std::vector<Task>& tasks,
                              const std::vector<ForeignResult>& results) {
  std::vector<Task> planned;
  for (const ForeignResult& result : results) {
    planned.push_back(MakeForeignTask(FindTask(tasks, result), result.system));
  }
  return planned;
}

void AddForeignResults(const ExperimentFolder& folder,
                       const std::vector<ForeignResult>& results) {
  if (results.empty()) return;
  const std::vector<Task> planned = PlanForeign(KnownTasks(folder), results);
  for (std::size_t i = 0; i < results.size(); ++i) {
    TaskRecord record;
    record.task = planned[i];
    record.state = TaskState::kRecorded;
    record.figures = EvaluateForeign(results[i], record.task.ground_truth);
    record.host = HostName();
    record.started = record.ended = TimeText();
    const std::string path = folder.TaskFolder(record.task.name);
    MakeFolder(path);
    WriteTaskRecord(path, record);
  }
}

}  // namespace splitfusion
