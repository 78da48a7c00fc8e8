// Time of the first stage, from colour image to refined masks (SplitFusion
// IV-A), on a 640x480 frame of the synthetic room with a person and a toy. The
// network runs if the environment variable SPLITFUSION_MODEL names an ONNX file
// (and SPLITFUSION_DECODER its decoder, else yolov8seg).

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/segmentation/network_segmenter.h"
#include "splitfusion/lib/split/instance_matcher.h"
#include "splitfusion/lib/split/surface_splitter.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"

namespace splitfusion {
namespace {

/// A frame, its detections, and an exact prediction of its surfaces.
class SplitFixture : public benchmark::Fixture {
 public:
  void SetUp(const benchmark::State&) override {
    const SyntheticScene scene{SyntheticOptions()};
    camera_ = scene.camera();
    frame_ = scene.Render(kFrame);
    points_ = ComputePointMap(frame_.frame.depth, camera_);
    detections_ = scene.Detections(frame_);
    for (const SyntheticInstance& instance : scene.instances()) {
      if (instance.category == "person") person_ = instance.id;
    }
    frame_.labels.convertTo(prediction_.labels, CV_16U);
    prediction_.labels.setTo(0, frame_.labels > person_);
    prediction_.depth = frame_.true_depth.clone();
    compared_ = CompareDepth(frame_.frame.depth, prediction_, PriorOptions());
  }

  cv::Mat_<uchar> PersonMask() const {
    return cv::Mat_<uchar>(frame_.labels == person_);
  }

 protected:
  static constexpr int kFrame = 40;

  PinholeCamera camera_;
  SyntheticFrame frame_;
  PointMap points_;
  std::vector<InstanceMask> detections_;
  SurfacePrediction prediction_;
  ComparedDepth compared_;
  int person_ = 1;
};

BENCHMARK_DEFINE_F(SplitFixture, MinCut)(benchmark::State& state) {
  const SurfaceObservation observation{person_, PersonMask(), {}, {}, {}};
  for (auto _ : state) {
    const SurfaceEvidence gathered = GatherEvidence(
        observation, compared_, GraphCutOptions(), PriorOptions());
    benchmark::DoNotOptimize(CutForeground(points_, frame_.frame.color,
                                           gathered.crop, gathered.evidence,
                                           GraphCutOptions()));
  }
  state.counters["pixels"] = cv::countNonZero(observation.mask);
}

/// Weight of the edge between two pixels, as MinCut has it but for its cases.
float BarestWeight(const PointMap& points, const cv::Mat_<cv::Vec3b>& color,
                   const cv::Point& p, const cv::Point& q) {
  const cv::Vec3f step = points.points(q) - points.points(p);
  const cv::Vec3f& np = points.normals(p);
  const cv::Vec3f& nq = points.normals(q);
  const float ratio = std::max(std::abs(np.dot(step)), std::abs(nq.dot(step))) *
                      (100 / (1 + points.points(p)[2]));
  const cv::Vec3b &a = color(p), &b = color(q);
  float square = 0;
  for (int c = 0; c < 3; ++c) square += float(a[c] - b[c]) * (a[c] - b[c]);
  return std::exp(-ratio * ratio - (1 - np.dot(nq))) *
         (1 - square / (square + 1600));
}

/// The weights of all edges of the crop, one after the other, and no cut.
BENCHMARK_DEFINE_F(SplitFixture, MinCutFloor)(benchmark::State& state) {
  const SurfaceObservation observation{person_, PersonMask(), {}, {}, {}};
  const SurfaceEvidence gathered =
      GatherEvidence(observation, compared_, GraphCutOptions(), PriorOptions());
  const cv::Rect inner(gathered.crop.x + 1, gathered.crop.y,
                       gathered.crop.width - 2, gathered.crop.height - 1);
  const cv::Mat_<cv::Vec3b> color = frame_.frame.color;
  const cv::Point offsets[4] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
  cv::Mat_<cv::Vec4f> weights(inner.size());
  std::size_t edges = 0;
  for (auto _ : state) {
    edges = 0;
    for (int v = 0; v < inner.height; ++v) {
      for (int u = 0; u < inner.width; ++u) {
        const cv::Point p(inner.x + u, inner.y + v);
        if (gathered.evidence(v, u + 1) <= kSurelyBackground) continue;
        if (!(points_.points(p)[2] > 0)) continue;
        for (int k = 0; k < 4; ++k, ++edges) {
          weights(v, u)[k] = BarestWeight(points_, color, p, p + offsets[k]);
        }
      }
    }
    benchmark::DoNotOptimize(weights.data);
  }
  state.counters["edges"] = static_cast<double>(edges);
}

BENCHMARK_DEFINE_F(SplitFixture, MatchInstances)(benchmark::State& state) {
  std::vector<Candidate> candidates;
  for (const InstanceMask& detection : detections_) {
    Candidate candidate;
    candidate.mask = detection.mask;
    candidates.push_back(candidate);
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(MatchInstances(candidates, prediction_.labels,
                                            compared_.agreement, {person_},
                                            MatchOptions()));
  }
  state.counters["detections"] = static_cast<double>(candidates.size());
}

BENCHMARK_DEFINE_F(SplitFixture, SplitFrame)(benchmark::State& state) {
  SurfaceSplitter splitter(camera_, LabelTable(), SplitOptions());
  for (auto _ : state) {
    ++frame_.frame.index;
    benchmark::DoNotOptimize(
        splitter.Split(frame_.frame, points_, detections_, {}));
  }
}

BENCHMARK_DEFINE_F(SplitFixture, Network)(benchmark::State& state) {
  const char* model = std::getenv("SPLITFUSION_MODEL");
  if (model == nullptr) {
    state.SkipWithError("skipped: no network given; see --model");
    return;
  }
  const char* decoder = std::getenv("SPLITFUSION_DECODER");
  try {
    NetworkOptions options;
    options.model = model;
    options.decoder = decoder != nullptr ? decoder : "yolov8seg";
    NetworkSegmenter segmenter(options);
    for (auto _ : state) {
      benchmark::DoNotOptimize(segmenter.Segment(frame_.frame));
    }
  } catch (const InputError& error) {
    state.SkipWithError(error.what());
  }
}

BENCHMARK_REGISTER_F(SplitFixture, MinCut)->Name("min_cut")->UseRealTime();
BENCHMARK_REGISTER_F(SplitFixture, MinCutFloor)
    ->Name("min_cut/floor")
    ->UseRealTime();
BENCHMARK_REGISTER_F(SplitFixture, MatchInstances)
    ->Name("matching")
    ->UseRealTime();
BENCHMARK_REGISTER_F(SplitFixture, SplitFrame)->Name("split")->UseRealTime();
BENCHMARK_REGISTER_F(SplitFixture, Network)->Name("network")->UseRealTime();

}  // namespace
}  // namespace splitfusion
