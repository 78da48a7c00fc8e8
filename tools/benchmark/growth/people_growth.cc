// The whole method, frame by frame, against the number of people in the room:
// every one is a non-rigid surface of its own. Parts of a frame are timed on
// one thread, where they add up to the whole.

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "growth_curves.h"
#include "masked_frames.h"
#include "people_scene.h"
#include "splitfusion/lib/report/frame_parts.h"
#include "splitfusion/lib/report/run_summary.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {
namespace {

/// Frames until all people are modelled and grown.
constexpr int kWarmUp = 4;

/// Default options; thresholds in pixels hold for 640x480 and are scaled.
PipelineOptions OptionsFor(const PinholeCamera& camera) {
  PipelineOptions options;
  const double scale = camera.width / 640.0;
  const auto scaled = [&](int pixels) {
    return std::max(1, static_cast<int>(pixels * scale * scale));
  };
  options.split.min_pixels = scaled(options.split.min_pixels);
  options.min_tracked_pixels = scaled(options.min_tracked_pixels);
  return options;
}

/// Holds everything to so many threads while it lives; 0: all cores.
class Threads {
 public:
  explicit Threads(int count)
      : control_(tbb::global_control::max_allowed_parallelism,
                 count > 0 ? count : tbb::info::default_concurrency()) {
    cv::setNumThreads(count > 0 ? count : -1);
  }
  ~Threads() { cv::setNumThreads(-1); }

 private:
  tbb::global_control control_;
};

std::vector<FrameReport> RunMethod(const PinholeCamera& camera,
                                   const std::vector<MaskedFrame>& film) {
  SplitFusion fusion(camera, OptionsFor(camera), LabelTable(),
                     std::make_shared<GivenMasks>(film));
  std::vector<FrameReport> reports;
  for (const MaskedFrame& frame : film) {
    reports.push_back(fusion.ProcessFrame(frame.frame));
  }
  return reports;
}

/// Keeps the least of all times, frame by frame; every run does the same.
void KeepFastest(const std::vector<FrameReport>& run,
                 std::vector<FrameReport>* fastest) {
  if (fastest->empty()) *fastest = run;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const auto keep = [&](double FrameReport::*seconds) {
      double& least = (*fastest)[i].*seconds;
      least = std::min(least, run[i].*seconds);
    };
    keep(&FrameReport::total_seconds);
    for (const FramePart& part : kFrameParts) keep(part.seconds);
  }
}

/// Median over the frames after the first ones.
double MedianSeconds(const std::vector<FrameReport>& reports,
                     double FrameReport::*seconds) {
  std::vector<double> values;
  const std::size_t first = std::min<std::size_t>(kWarmUp, reports.size() - 1);
  for (std::size_t i = first; i < reports.size(); ++i) {
    values.push_back(reports[i].*seconds);
  }
  return Median(std::move(values));
}

/// A scene on film, and what its frames cost.
struct PeopleRuns {
  int people;
  PinholeCamera camera;
  std::vector<MaskedFrame> film;
  std::vector<FrameReport> all_cores, one_thread;
};

PeopleRuns Film(int people, const GrowthSizes& sizes) {
  const PeopleScene scene(people, sizes.run_height);
  return {people, scene.camera(), FilmScene(scene, sizes.frames), {}, {}};
}

/// Rows of one scene, parts on one thread.
void AddPeopleRows(const PeopleRuns& runs, GrowthTable* table) {
  const auto add = [&](const std::string& series, const auto& reports,
                       double FrameReport::*seconds) {
    const auto surfaces = static_cast<double>(reports.back().surfaces.size());
    table->rows.push_back({GrowthLabel(runs.people),
                           series,
                           {MedianSeconds(reports, seconds), surfaces}});
  };
  add("total", runs.all_cores, &FrameReport::total_seconds);
  add("total_one_thread", runs.one_thread, &FrameReport::total_seconds);
  for (const FramePart& part : kFrameParts) {
    add(part.name, runs.one_thread, part.seconds);
  }
}

}  // namespace

GrowthTable PeopleCurve(const GrowthSizes& sizes) {
  std::vector<PeopleRuns> scenes;
  for (const int people : sizes.people) scenes.push_back(Film(people, sizes));
  // In this order: TBB that was held to one thread does not soon use all again.
  for (const bool alone : {false, true}) {
    const Threads threads(alone ? 1 : 0);
    for (int run = 0; run < sizes.runs; ++run) {
      for (PeopleRuns& scene : scenes) {
        KeepFastest(RunMethod(scene.camera, scene.film),
                    alone ? &scene.one_thread : &scene.all_cores);
      }
    }
  }
  GrowthTable table;
  table.columns = {"people", "series", "seconds", "surfaces"};
  for (const PeopleRuns& scene : scenes) AddPeopleRows(scene, &table);
  return table;
}

}  // namespace splitfusion
