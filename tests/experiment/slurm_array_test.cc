#include "splitfusion/lib/experiment/slurm_array.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "experiment/sweep_fixture.h"
#include "splitfusion/lib/experiment/task_list.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Options of a sweep whose paths sh and Slurm would take apart.
SweepOptions HostileOptions(const TemporaryFolder& folder) {
  SweepOptions options;
  options.run_program = "/bin/sf_run";
  options.output = folder / "o u't $HOME 100%";
  options.runner.evaluate_program = "/bin/sf_evaluate";
  return options;
}

/// What `sh` makes of a script when sbatch prints its words and its input.
std::string Submitted(const TemporaryFolder& folder,
                      const std::string& script) {
  WriteScript(folder, "bin/sbatch",
              "#!/bin/sh\n"
              "for word in \"$@\"; do echo \"[$word]\"; done\ncat\n");
  const std::string path = folder.Write("submit.sh", script);
  const std::string command = "PATH='" + (folder / "bin") + "':$PATH sh '" +
                              path + "' --partition=short >'" +
                              (folder / "submitted") + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return folder.Read("submitted");
}

std::vector<Task> Tasks(int count) {
  std::vector<Task> tasks(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    tasks[static_cast<std::size_t>(i)].name = "task" + std::to_string(i);
  }
  return tasks;
}

TEST(SlurmArray, HasAnArrayForEveryChunk) {
  const TemporaryFolder folder;
  SlurmArray array = MakeSlurmArray(Tasks(7), HostileOptions(folder),
                                    "/bin/sf_batch", folder / "list");
  array.max_array = 3;
  const std::string text = Submitted(folder, SlurmScript(array));
  EXPECT_THAT(text, HasSubstr("[--array=0-2]\n"));
  EXPECT_THAT(text, HasSubstr("[--partition=short]\n[/dev/stdin]\n[4]\n"));
  EXPECT_THAT(text, HasSubstr("[--array=0-0]\n"));
  EXPECT_THAT(text, HasSubstr("[/dev/stdin]\n[7]\n"));
  EXPECT_THAT(text, Not(HasSubstr("[10]")));
  array.tasks = 0;
  EXPECT_EQ(Submitted(folder, SlurmScript(array)), "");
}

TEST(SlurmArray, AsksForWhatARunMayUse) {
  const TemporaryFolder folder;
  SweepOptions options = HostileOptions(folder);
  const auto script = [&] {
    return SlurmScript(MakeSlurmArray(Tasks(1), options, "b", "list"));
  };
  const std::string plain = script();
  EXPECT_THAT(plain, HasSubstr("#SBATCH --requeue\n"));
  EXPECT_THAT(plain, HasSubstr("#SBATCH --open-mode=append\n"));
  EXPECT_THAT(plain, HasSubstr("#SBATCH --cpus-per-task=1\n"));
  EXPECT_THAT(plain, Not(HasSubstr("--mem")));
  EXPECT_THAT(plain, Not(HasSubstr("--time")));
  options.threads = 4;
  options.runner.limits.wall_seconds = 90;
  options.runner.limits.memory_bytes = 2000000000;
  options.runner.keep_failed = true;
  const std::string limited = script();
  EXPECT_THAT(limited, HasSubstr("#SBATCH --cpus-per-task=4\n"));
  EXPECT_THAT(limited, HasSubstr("#SBATCH --mem=2420M\n"));  // 1908 + 512.
  EXPECT_THAT(limited, HasSubstr("#SBATCH --time=12\n"));
  EXPECT_THAT(limited,
              HasSubstr("'--threads=4' '--max_wall_minutes=1.5' "
                        "'--max_memory_gb=2' '--keep_failed' '--task_list="));
}

TEST(SlurmArray, HasTheThreadsOfTheTaskThatTakesMost) {
  std::vector<Task> tasks = Tasks(2);
  tasks[1].settings.Set("threads", "6");
  SweepOptions options = HostileOptions(TemporaryFolder());
  options.threads = 2;
  EXPECT_EQ(MakeSlurmArray(tasks, options, "b", "list").cpus, 6);
}

TEST(SlurmArray, QuotesPaths) {
  const TemporaryFolder folder;
  const SweepOptions options = HostileOptions(folder);
  const std::string program =
      WriteScript(folder, "b'in $x/sf_batch",
                  "#!/bin/sh\nfor word in \"$@\"; do echo \"<$word>\"; done\n");
  const std::string list = options.output + "/slurm/list";
  const std::string text = Submitted(
      folder, SlurmScript(MakeSlurmArray(Tasks(1), options, program, list)));
  EXPECT_THAT(text, HasSubstr("[--output=" + (folder / "o u't $HOME 100%%") +
                              "/slurm/%A_%a.log]\n"));
  // What an element would run.
  const std::string element =
      folder.Write("element.sh", text.substr(text.find("#!/bin/sh")));
  const std::string command = "SLURM_ARRAY_TASK_ID=4 sh '" + element +
                              "' 3 >'" + (folder / "words") + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string words = folder.Read("words");
  EXPECT_THAT(words, HasSubstr("<run>\n<--output=" + options.output + ">\n"));
  EXPECT_THAT(words, HasSubstr("<--task_list=" + list + ">\n<--task=7>\n"));
}

TEST(SlurmArray, RefusesArraysWithoutElements) {
  SlurmArray array;
  array.max_array = 0;
  ExpectInputError([&] { SlurmScript(array); }, "slurm_max_array = 0");
}

TEST(UnfinishedTasks, AreThoseThatARunWouldNotJustKeep) {
  std::vector<PlannedTask> planned;
  for (const char* what : {"new", "finished", "recorded", "failed: why",
                           "unfinished", "running", "changed: a"}) {
    planned.emplace_back();
    planned.back().first.name = what;
    planned.back().second = what;
  }
  const auto names = [&](bool keep_failed) {
    std::string text;
    for (const Task& task : UnfinishedTasks(planned, keep_failed)) {
      text += task.name + ",";
    }
    return text;
  };
  EXPECT_EQ(names(false), "new,failed: why,unfinished,running,changed: a,");
  EXPECT_EQ(names(true), "new,unfinished,running,changed: a,");
}

TEST_F(SweepTest, ATaskOfAListIsRunAsBySweeps) {
  for (const char* name : {"room", "hall"}) AddSequence(name, "true");
  AddExperiment(ExperimentFolder(folder_.Make("out")), experiment_);
  const std::vector<Task> tasks = PlanTasks(experiment_);
  const std::string list = WriteTaskList(folder_ / "out/slurm", tasks);
  EXPECT_EQ(WriteTaskList(folder_ / "out/slurm", tasks), list);
  EXPECT_NE(WriteTaskList(folder_ / "out/slurm", {tasks[1]}), list);
  EXPECT_EQ(RunTasks({ReadTaskOfList(list, 2)}, options_).ended, 1);
  EXPECT_EQ(Starts("room"), 0);
  EXPECT_EQ(Starts("hall"), 1);
  const ResultTable table = Table();
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0].status, "waiting");
  EXPECT_EQ(table.rows[1].status, "complete");
  const auto planned = DryRun(tasks, options_);
  EXPECT_EQ(planned[0].second, "new");
  EXPECT_EQ(planned[1].second, "finished");
}

TEST(TaskList, SaysWhichLineIsWrong) {
  const TemporaryFolder folder;
  const std::string list = WriteTaskList(folder / "slurm", Tasks(2));
  EXPECT_EQ(ReadTaskOfList(list, 1).name, "task0");
  for (const int line : {-1, 0, 3}) {
    ExpectInputError([&] { ReadTaskOfList(list, line); },
                     "task = " + std::to_string(line) + ": expected a line of");
  }
  ExpectInputError([&] { ReadTaskOfList(folder / "none", 1); },
                   "none: cannot be opened");
  const std::string damaged = folder.Write("damaged", "{\"task\": 3}\nrubbish");
  ExpectInputError([&] { ReadTaskOfList(damaged, 1); }, "damaged:1: task: ");
  ExpectInputError([&] { ReadTaskOfList(damaged, 2); },
                   "damaged:2: expected a task in JSON");
}

}  // namespace
}  // namespace splitfusion
