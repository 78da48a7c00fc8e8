// A frame of the whole method: the built-in scene (room, walking person, soft
// toy) at 640x480 with noise, masks given, as sf_run has it apart from reading
// and writing files.

#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {
namespace {

constexpr int kFrames = 10;

/// Some frames of the built-in sequence with their detections.
struct Sequence {
  Sequence() : scene(Options()) {
    for (int i = 0; i < kFrames; ++i) {
      const SyntheticFrame frame = scene.Render(i);
      frames.push_back(frame.frame);
      detections.push_back(scene.Detections(frame));
    }
  }

  static SyntheticOptions Options() {
    SyntheticOptions options;
    options.frames = kFrames;
    return options;
  }

  SyntheticScene scene;
  std::vector<Frame> frames;
  std::vector<std::vector<InstanceMask>> detections;
};

/// Hands out the detections of a sequence.
class GivenDetections : public Segmenter {
 public:
  explicit GivenDetections(const Sequence& sequence) : sequence_(sequence) {}
  std::vector<InstanceMask> Segment(const Frame& frame) override {
    return sequence_.detections[frame.index];
  }

 private:
  const Sequence& sequence_;
};

void EndToEnd(benchmark::State& state) {
  const Sequence sequence;
  for (auto _ : state) {
    SplitFusion fusion(sequence.scene.camera(), PipelineOptions(), LabelTable(),
                       std::make_shared<GivenDetections>(sequence),
                       BuiltinTerms());
    const Stopwatch watch;
    for (const Frame& frame : sequence.frames) fusion.ProcessFrame(frame);
    state.SetIterationTime(watch.Seconds() / kFrames);
  }
}
BENCHMARK(EndToEnd)
    ->Name("end_to_end_frame")
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace splitfusion
