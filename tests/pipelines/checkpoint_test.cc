// A run that is saved, destroyed, restored and continued gives the same bytes
// as one that nobody disturbed.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <sstream>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/report/report_json.h"
#include "splitfusion/lib/report/surface_output.h"
#include "splitfusion/pipelines/presets.h"
#include "support/expect_input_error.h"
#include "support/synthetic_run.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// Changes the input of a frame.
using Script =
    std::function<void(int frame, Frame*, std::vector<InstanceMask>*)>;

/// What is run.
struct Story {
  SyntheticOptions scene = SyntheticRun::Quick();
  PipelineOptions options;
  Script script = [](int, Frame*, std::vector<InstanceMask>*) {};
};

/// A report without times and what hangs on them.
std::string TextOf(FrameReport report) {
  nlohmann::ordered_json json = ToJson(report);
  const std::function<void(nlohmann::ordered_json*)> strip =
      [&](nlohmann::ordered_json* value) {
        if (value->is_object()) value->erase("seconds");
        for (auto& item : *value) {
          if (item.is_structured()) strip(&item);
        }
      };
  strip(&json);
  return json.dump();
}

/// The results of Finish() without the volumes, whose files have random ids.
std::string FinalFiles(SyntheticRun* run) {
  namespace fs = std::filesystem;
  run->fusion().Finish();
  const TemporaryFolder folder;
  for (const auto& [id, surface] : run->fusion().surfaces()) {
    WriteSurface(RunPaths(folder.Make("run")), *surface, surface->Model(),
                 {1, true});
  }
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "run")) {
    const std::string name = fs::relative(entry.path(), folder / "").string();
    if (!entry.is_regular_file() || entry.path().extension() == ".vdb")
      continue;
    files[name] = folder.Read(name);
  }
  EXPECT_GE(files.size(), 3 * run->fusion().surfaces().size());
  std::string all;
  for (const auto& [name, text] : files) all += name + "\n" + text;
  return all;
}

/// An undisturbed run.
struct Record {
  std::vector<std::string> states;   // After every frame.
  std::vector<std::string> reports;  // Of every frame.
  std::set<std::string> events;      // Of surfaces and of the splitter.
  std::string files;
};

std::string Step(const Story& story, int frame, SyntheticRun* run,
                 std::set<std::string>* events) {
  const FrameReport report =
      run->Next([&](Frame* input, std::vector<InstanceMask>* detections) {
        story.script(frame, input, detections);
      });
  for (const auto& surface : report.surfaces) {
    events->insert(ToString(surface.state));
    events->insert(surface.event);
  }
  for (const auto& split : report.decisions) {
    events->insert(split.action);
    events->insert(split.class_name);
  }
  return TextOf(report);
}

Record RunUndisturbed(const Story& story) {
  SyntheticRun run(story.scene, story.options);
  Record record;
  for (int i = 0; i < story.scene.frames; ++i) {
    record.reports.push_back(Step(story, i, &run, &record.events));
    record.states.push_back(run.State());
  }
  record.files = FinalFiles(&run);
  return record;
}

/// Goes on from every state after `first` for `frames` frames, and from some to
/// the end.
void ExpectResumable(const Story& story, const Record& record, int first,
                     int frames) {
  std::set<std::string> events;
  for (int saved = first; saved < story.scene.frames; ++saved) {
    SyntheticRun run(story.scene, story.options);
    run.RestartFrom(record.states[saved]);
    ASSERT_TRUE(run.State() == record.states[saved]) << saved;
    const bool to_end = saved % 4 == 0 || saved + 1 == story.scene.frames;
    const int end = to_end ? story.scene.frames
                           : std::min(story.scene.frames, saved + 1 + frames);
    for (int i = saved + 1; i < end; ++i) {
      ASSERT_EQ(Step(story, i, &run, &events), record.reports[i])
          << "frame " << i << " from " << saved;
      ASSERT_TRUE(run.State() == record.states[i])
          << "frame " << i << " from " << saved;
    }
    if (to_end) {
      ASSERT_TRUE(FinalFiles(&run) == record.files) << saved;
    }
  }
}

TEST(Checkpoint, EveryFrameOfAPersonsRunCanBeGoneOnFrom) {
  const Story story;
  const Record record = RunUndisturbed(story);
  EXPECT_EQ(record.events.count("tracked"), 1u);
  ExpectResumable(story, record, 0, 2);
}

TEST(Checkpoint, ARunMayBeInterruptedAfterEveryFrame) {
  const Story story;
  const Record record = RunUndisturbed(story);
  SyntheticRun run(story.scene, story.options);
  std::set<std::string> events;
  for (int i = 0; i < story.scene.frames; ++i) {
    EXPECT_EQ(Step(story, i, &run, &events), record.reports[i]);
    run.RestartFrom(run.State());
  }
  EXPECT_TRUE(run.State() == record.states.back());
  EXPECT_TRUE(FinalFiles(&run) == record.files);
}

TEST(Checkpoint, ThreadsDoNotMatter) {
  const Story story;
  const auto with_threads = [](int threads) {
    return tbb::global_control(tbb::global_control::max_allowed_parallelism,
                               threads);
  };
  Record record;
  {
    const auto two = with_threads(2);
    record = RunUndisturbed(story);
  }
  const auto one = with_threads(1);
  ExpectResumable(story, record, 5, 1);
}

/// A board before all of a person but a strip of his left side.
void HideBehindBoard(Frame* frame, std::vector<InstanceMask>* detections) {
  for (InstanceMask& detection : *detections) {
    if (detection.class_name != "person") continue;
    cv::Rect box = cv::boundingRect(detection.mask);
    box.x += box.width / 5;
    const cv::Rect image(0, 0, frame->depth.cols, frame->depth.rows);
    const cv::Rect board = cv::Rect(box.x, 0, box.width, image.height) & image;
    frame->depth(board).setTo(0.7f);
    detection.mask(board).setTo(0);
    InstanceMask occluder = detection;
    occluder.class_name = "dog";
    occluder.mask = cv::Mat::zeros(image.size(), detection.mask.type());
    occluder.mask(board).setTo(255);
    detections->push_back(occluder);
    return;
  }
}

TEST(Checkpoint, HiddenLostAndDormantSurfacesGoOn) {
  Story story;
  story.scene.frames = 22;
  story.options.split.max_missed_frames = 2;
  story.script = [](int frame, Frame* input,
                    std::vector<InstanceMask>* detections) {
    if (frame < 2) detections->clear();  // Born later.
    if (frame >= 6 && frame < 9) HideBehindBoard(input, detections);
    if (frame == 11) input->depth.setTo(0);
    if (frame >= 13 && frame < 17) detections->clear();
  };
  const Record record = RunUndisturbed(story);
  for (const std::string event : {"born", "tracked", "occluded", "lost",
                                  "missed", "inactive", "revived"}) {
    EXPECT_EQ(record.events.count(event), 1u) << event;
  }
  ExpectResumable(story, record, 0, 2);
}

TEST(Checkpoint, WhatIsHeldGoesOn) {
  Story story;
  story.options.split.merge_touching = "person+handbag";
  story.script = [](int frame, Frame*, std::vector<InstanceMask>* detections) {
    const std::size_t count = detections->size();
    for (std::size_t i = 0; i < count && frame > 1; ++i) {
      if (detections->at(i).class_name != "person") continue;
      InstanceMask bag = detections->at(i);  // The lower half.
      const cv::Rect box = cv::boundingRect(bag.mask);
      bag.mask = bag.mask.clone();
      bag.mask.rowRange(0, box.y + box.height / 2).setTo(0);
      detections->at(i).mask.setTo(0, bag.mask);
      bag.class_name = "handbag";
      detections->push_back(bag);
    }
  };
  const Record record = RunUndisturbed(story);
  EXPECT_EQ(record.events.count("person"), 1u);
  EXPECT_EQ(record.events.count("handbag"), 0u);  // It is the person's.
  ExpectResumable(story, record, 0, 2);
}

/// A board that begins to move to the right in frame 8.
void AddRollingBoard(int frame, Frame* input,
                     std::vector<InstanceMask>* detections) {
  const cv::Rect at(30 + 2 * std::max(0, frame - 8), 35, 30, 35);
  input->depth(at) = 2.0;
  input->color(at) = cv::Scalar(40, 90, 160);
  cv::Mat mask = cv::Mat::zeros(input->depth.size(), CV_8UC1);
  mask(at) = 255;
  detections->push_back({mask, "suitcase", 0.9});
}

TEST(Checkpoint, AThingThatBeginsToMoveGoesOn) {
  Story story;
  story.scene.scene = SyntheticSceneKind::kRoom;
  story.scene.frames = 36;
  story.scene.camera_motion = 0;
  story.script = AddRollingBoard;
  const Record record = RunUndisturbed(story);
  EXPECT_EQ(record.events.count("born"), 1u);
  EXPECT_NE(record.files.find("suitcase"), std::string::npos);
  ExpectResumable(story, record, 6, 1);
}

TEST(Checkpoint, EveryPresetGoesOn) {
  for (const std::string& name : PresetNames()) {
    SCOPED_TRACE(name);
    Story story;
    story.scene.frames = 7;
    ApplyPreset(name, &story.options);
    ExpectResumable(story, RunUndisturbed(story), 0, 2);
  }
}

TEST(Checkpoint, BeforeTheFirstFrameThereIsNothing) {
  const Story story;
  SyntheticRun run(story.scene, story.options);
  run.RestartFrom(run.State());
  run.Next();
  EXPECT_TRUE(run.State() == RunUndisturbed(story).states[0]);
}

TEST(Checkpoint, RefusesAnotherCameraOrOtherVoxels) {
  SyntheticRun run(SyntheticRun::Quick());
  run.Next();
  const std::string state = run.State();
  SyntheticOptions wider = SyntheticRun::Quick();
  wider.width = 320;
  ExpectInputError([&] { SyntheticRun(wider).RestartFrom(state); },
                   "width = 160: expected 320");
  PipelineOptions options;
  options.background.tsdf.voxel_size *= 1.0001;
  ExpectInputError(
      [&] { SyntheticRun(SyntheticRun::Quick(), options).RestartFrom(state); },
      "state: section 'volume': voxel_size = ");
}

TEST(Checkpoint, RefusesAStateThatIsCut) {
  SyntheticRun run(SyntheticRun::Quick());
  run.Next();
  const std::string state = run.State();
  for (std::size_t size = 0; size < state.size(); size += state.size() / 50) {
    EXPECT_THROW(
        SyntheticRun(SyntheticRun::Quick()).RestartFrom(state.substr(0, size)),
        InputError);
  }
}

}  // namespace
}  // namespace splitfusion
