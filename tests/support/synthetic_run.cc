#include "support/synthetic_run.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <utility>

#include "splitfusion/lib/base/archive.h"

namespace splitfusion {
namespace {

template <typename T>
bool SameBytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

bool SameSurface(const Surface& a, const Surface& b) {
  if (a.history().size() != b.history().size()) return false;
  for (int i = 0; i < a.history().size(); ++i) {
    if (!SameBytes(a.history().At(i).motions, b.history().At(i).motions)) {
      return false;
    }
  }
  return SameBytes(a.graph().positions, b.graph().positions) &&
         a.graph().neighbors == b.graph().neighbors &&
         SameBytes(a.mesh().vertices, b.mesh().vertices) &&
         SameBytes(a.mesh().triangles, b.mesh().triangles) &&
         SameBytes(a.mesh().colors, b.mesh().colors);
}

}  // namespace

/// Hands out what it was given.
class SyntheticRun::Detections : public Segmenter {
 public:
  std::vector<InstanceMask> Segment(const Frame&) override { return masks; }
  std::vector<InstanceMask> masks;
};

SyntheticRun::SyntheticRun(const SyntheticOptions& scene_options,
                           PipelineOptions options,
                           const Registries& registries)
    : scene_(scene_options),
      options_(std::move(options)),
      registries_(registries),
      detections_(std::make_shared<Detections>()) {
  const double scale = scene_options.width / 640.0;
  const auto scaled = [&](int pixels) {
    return std::max(1, static_cast<int>(pixels * scale * scale));
  };
  options_.split.min_pixels = scaled(options_.split.min_pixels);
  options_.min_tracked_pixels = scaled(options_.min_tracked_pixels);
  fusion_ = MakeFusion();
}

std::unique_ptr<SplitFusion> SyntheticRun::MakeFusion() const {
  return std::make_unique<SplitFusion>(scene_.camera(), options_, LabelTable(),
                                       detections_, registries_);
}

std::string SyntheticRun::State() const {
  std::ostringstream out;
  ArchiveWriter archive(&out);
  archive(next_, *fusion_);
  archive.Flush();
  return out.str();
}

void SyntheticRun::RestartFrom(const std::string& state) {
  fusion_ = MakeFusion();
  std::istringstream in(state);
  ArchiveReader archive(&in, state.size(), "state");
  archive(next_, *fusion_);
}

FrameReport SyntheticRun::Next(const Spoil& spoil) {
  frame_ = scene_.Render(next_++);
  detections_->masks = scene_.Detections(frame_);
  Frame input = frame_.frame;
  input.color = input.color.clone();
  input.depth = input.depth.clone();
  if (spoil) spoil(&input, &detections_->masks);
  return fusion_->ProcessFrame(input);
}

Trajectory SyntheticRun::TrueTrajectory() const {
  Trajectory truth;
  for (int i = 0; i < next_; ++i) {
    truth.push_back({scene_.Timestamp(i), scene_.WorldFromCamera(i)});
  }
  return truth;
}

double SyntheticRun::MedianDepthError(int surface) const {
  const SceneRendering model = RenderScene(
      fusion_->surfaces(), fusion_->camera(), fusion_->options().ray_cast);
  const cv::Mat_<float> depth = frame_.true_depth;
  std::vector<double> errors;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const float z = model.map.points(v, u)[2];
      if (model.labels(v, u) != surface || z == 0 || depth(v, u) == 0 ||
          fusion_->labels()(v, u) != surface) {
        continue;
      }
      errors.push_back(std::abs(z - depth(v, u)));
    }
  }
  if (errors.empty()) return std::nan("");
  const auto middle = errors.begin() + errors.size() / 2;
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

SyntheticOptions SyntheticRun::Quick() {
  SyntheticOptions options;
  options.width = 160, options.height = 120;
  options.frames = 12;
  options.noise = false;
  options.exact_masks = true;
  options.track_points = 10;
  return options;
}

bool SameResults(const SplitFusion& a, const SplitFusion& b) {
  if (a.surfaces().size() != b.surfaces().size() ||
      a.trajectory().size() != b.trajectory().size()) {
    return false;
  }
  for (std::size_t i = 0; i < a.trajectory().size(); ++i) {
    if (a.trajectory()[i].world_from_camera.matrix() !=
        b.trajectory()[i].world_from_camera.matrix()) {
      return false;
    }
  }
  for (const auto& [id, surface] : a.surfaces()) {
    const auto other = b.surfaces().find(id);
    if (other == b.surfaces().end() || !SameSurface(*surface, *other->second)) {
      return false;
    }
  }
  return true;
}

}  // namespace splitfusion
