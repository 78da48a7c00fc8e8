#ifndef SPLITFUSION_TOOLS_BENCHMARK_LABELLED_VIEW_H_
#define SPLITFUSION_TOOLS_BENCHMARK_LABELLED_VIEW_H_

#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"

namespace splitfusion {

/// What a frame of a scene (SyntheticScene or PeopleScene) shows, labelled
/// exactly.
template <typename Scene>
LiveView LabelledView(const Scene& scene, int frame) {
  const SyntheticFrame rendered = scene.Render(frame);
  LiveView live =
      MakeLiveView(scene.camera(), rendered.frame.depth, rendered.frame.color);
  rendered.labels.convertTo(live.labels, CV_16U);
  return live;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_LABELLED_VIEW_H_
