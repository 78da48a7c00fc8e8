// A frame of the whole method: the built-in scene (room, walking person, soft
// toy) at 640x480 with noise, masks given, as sf_run has it apart from reading
// and writing files.

#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "masked_frames.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {
namespace {

constexpr int kFrames = 10;

void EndToEnd(benchmark::State& state) {
  SyntheticOptions options;
  options.frames = kFrames;
  const SyntheticScene scene(options);
  const std::vector<MaskedFrame> film = FilmScene(scene, kFrames);
  for (auto _ : state) {
    SplitFusion fusion(scene.camera(), PipelineOptions(), LabelTable(),
                       std::make_shared<GivenMasks>(film));
    const Stopwatch watch;
    for (const MaskedFrame& frame : film) fusion.ProcessFrame(frame.frame);
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
