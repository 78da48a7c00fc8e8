#ifndef SPLITFUSION_TOOLS_BENCHMARK_MASKED_FRAMES_H_
#define SPLITFUSION_TOOLS_BENCHMARK_MASKED_FRAMES_H_

#include <utility>
#include <vector>

#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"

namespace splitfusion {

/// A frame with its masks.
struct MaskedFrame {
  Frame frame;                      ///< Its index is its place in the film.
  std::vector<InstanceMask> masks;  ///< Of that frame.
};

/// The first frames of a scene (SyntheticScene or PeopleScene) with the masks
/// that its detector gives.
template <typename Scene>
std::vector<MaskedFrame> FilmScene(const Scene& scene, int count) {
  std::vector<MaskedFrame> film;
  for (int i = 0; i < count; ++i) {
    const SyntheticFrame rendered = scene.Render(i);
    film.push_back({rendered.frame, scene.Detections(rendered)});
  }
  return film;
}

/// Hands out the masks of a film.
class GivenMasks : public Segmenter {
 public:
  /// Only of these frames.
  explicit GivenMasks(std::vector<MaskedFrame> film) : film_(std::move(film)) {}

  /// The masks that the frame has by its index.
  std::vector<InstanceMask> Segment(const Frame& frame) override {
    return film_.at(frame.index).masks;
  }

 private:
  const std::vector<MaskedFrame> film_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_MASKED_FRAMES_H_
