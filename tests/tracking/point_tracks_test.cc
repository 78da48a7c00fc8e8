#include "splitfusion/lib/tracking/point_tracks.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/base/thread_limit.h"
#include "splitfusion/lib/deformation/deformation_graph.h"

namespace splitfusion {
namespace {

const PinholeCamera kTracksCamera{320, 240, 260, 260, 160, 120};
constexpr float kTracksDepth = 1.3f;

/// A plate at kTracksDepth, surface 1, that fills the image and moves through
/// it.
LiveView ViewOfPlate(const cv::Point2f& way) {
  cv::Mat color(240, 320, CV_8UC3);
  cv::RNG random(1);
  random.fill(color, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(color, color, cv::Size(), 2);
  cv::normalize(color, color, 0, 255, cv::NORM_MINMAX);
  const cv::Matx23f shift(1, 0, way.x, 0, 1, way.y);
  cv::warpAffine(color, color, shift, color.size(), cv::INTER_LINEAR,
                 cv::BORDER_REFLECT);
  LiveView live = MakeLiveView(kTracksCamera,
                               cv::Mat_<float>(240, 320, kTracksDepth), color);
  live.labels.setTo(1);
  return live;
}

/// Samples of the plate's middle where it is first seen; canonical is camera.
std::vector<ModelSample> PlateSamples() {
  std::vector<ModelSample> samples;
  for (int v = 60; v < 180; v += 2) {
    for (int u = 80; u < 240; u += 2) {
      ModelSample sample;
      sample.point = kTracksCamera.BackProject<float>(
          static_cast<float>(u), static_cast<float>(v), kTracksDepth);
      sample.normal = -Eigen::Vector3f::UnitZ();
      sample.u = u;
      sample.v = v;
      samples.push_back(sample);
    }
  }
  return samples;
}

/// Tracks that were begun on the plate at rest.
class PlateTracks {
 public:
  explicit PlateTracks(const PointTrackOptions& options = {})
      : tracks_(options) {
    for (ModelSample& sample : samples_) {
      sample.skinning = index_.Skin(sample.point);
    }
    tracks_.Follow(ViewOfPlate({0, 0}), {1});
    tracks_.Begin(1, samples_, WarpField(graph_), ViewOfPlate({0, 0}));
  }

  void Follow(const LiveView& live) { tracks_.Follow(live, {1}); }
  std::vector<TrackedPoint> Find(const LiveView& live,
                                 double max_change = 0.1) const {
    return tracks_.Find(1, samples_, index_, WarpField(graph_), live,
                        max_change);
  }
  std::size_t count() const { return tracks_.Of(1).size(); }
  PointTracks& tracks() { return tracks_; }
  std::vector<ModelSample>& samples() { return samples_; }
  const DeformationGraph& graph() const { return graph_; }

 private:
  DeformationGraph graph_ = MakeRigidGraph(Rigid3d::Identity());
  SkinningIndex index_ = SkinningIndex(graph_, 6);
  std::vector<ModelSample> samples_ = PlateSamples();
  PointTracks tracks_;
};

TEST(PointTracks, OneBeginsInEveryCell) {
  EXPECT_EQ(PlateTracks().count(), 16u * 20u);
  PointTrackOptions options;
  options.spacing = 40;
  EXPECT_EQ(PlateTracks(options).count(), 4u * 4u);
}

TEST(PointTracks, ArePointsOfTheModelSeenWhereTheyHaveMoved) {
  PlateTracks plate;
  const std::size_t begun = plate.count();
  LiveView live;
  for (const float step : {1.f, 2.f, 3.f, 4.f}) {
    live = ViewOfPlate({5 * step, -2.5f * step});
    plate.Follow(live);
  }
  const std::vector<TrackedPoint> points = plate.Find(live);
  EXPECT_GT(points.size(), 0.9 * begun);
  const Eigen::Vector3f way(20 * kTracksDepth / 260, -10 * kTracksDepth / 260,
                            0);
  for (const TrackedPoint& point : points) {
    EXPECT_LT((point.target - point.model.point - way).norm(), 0.001);
    EXPECT_EQ(point.model.skinning.count, 1);
    EXPECT_NEAR(point.weight, DepthNoise().Confidence(kTracksDepth), 1e-3);
  }
}

TEST(PointTracks, EndWhereThePixelDoesNotShowTheSurface) {
  PlateTracks plate;
  LiveView live = ViewOfPlate({2, 0});
  live.labels.colRange(0, 160).setTo(2);
  plate.Follow(live);
  EXPECT_GT(plate.count(), 100u);
  for (const PointTrack& track : plate.tracks().Of(1)) {
    EXPECT_GE(track.pixel.x(), 159);
  }
  const std::size_t left = plate.count();
  live.labels.setTo(1);
  plate.Follow(live);
  EXPECT_LE(plate.count(), left) << "those that ended came back";
}

TEST(PointTracks, EndWhereTheFlowDoesNotReturn) {
  PlateTracks plate;
  const std::size_t begun = plate.count();
  LiveView other = ViewOfPlate({0, 0});
  cv::flip(other.color, other.color, 0);
  plate.Follow(other);
  // Some return by chance.
  EXPECT_LT(plate.count(), begun / 4);
}

TEST(PointTracks, EndWithTheirSurface) {
  PlateTracks plate;
  plate.tracks().End(1);
  plate.Follow(ViewOfPlate({1, 0}));
  EXPECT_EQ(plate.count(), 0u);
  PlateTracks other;
  other.tracks().Follow(ViewOfPlate({1, 0}), {2});
  other.Follow(ViewOfPlate({1, 0}));
  EXPECT_EQ(other.count(), 0u);
}

TEST(PointTracks, BeginAnewWhereTheyEnded) {
  PlateTracks plate;
  const std::size_t begun = plate.count();
  LiveView live = ViewOfPlate({0, 0});
  live.labels.colRange(0, 160).setTo(2);
  plate.Follow(live);
  ASSERT_LT(plate.count(), begun);
  live.labels.setTo(1);
  plate.Follow(live);
  plate.tracks().Begin(1, plate.samples(), WarpField(plate.graph()), live);
  EXPECT_NEAR(static_cast<double>(plate.count()), static_cast<double>(begun),
              10);
}

TEST(PointTracks, BeginOnDepthAlone) {
  PlateTracks plate;
  plate.tracks().End(1);
  LiveView live = ViewOfPlate({0, 0});
  plate.Follow(live);
  live.depth.colRange(0, 160) = kTracksDepth + 0.03f;
  plate.tracks().Begin(1, plate.samples(), WarpField(plate.graph()), live);
  EXPECT_NEAR(static_cast<double>(plate.count()), 15 * 10, 15);
  for (const PointTrack& track : plate.tracks().Of(1)) {
    EXPECT_GE(track.pixel.x(), 159);
  }
}

TEST(PointTracks, WhatIsHiddenOrBehindSomethingIsNotFound) {
  PlateTracks plate;
  LiveView live = ViewOfPlate({0, 0});
  plate.Follow(live);
  const std::size_t all = plate.Find(live).size();
  live.depth.colRange(0, 160) = kTracksDepth - 0.15f;
  EXPECT_NEAR(static_cast<double>(plate.Find(live).size()), all / 2.0, 15);
  EXPECT_EQ(plate.Find(live, 0.2).size(), all);
  live.depth.setTo(kTracksDepth);
  // The lower half of the model is not in view.
  plate.samples().resize(plate.samples().size() / 2);
  EXPECT_NEAR(static_cast<double>(plate.Find(live).size()), all / 2.0, 30);
}

TEST(PointTracks, AreTheSameWithAnyNumberOfThreads) {
  const auto follow = [](int threads) {
    const ThreadLimit limit(threads);
    PlateTracks plate;
    plate.Follow(ViewOfPlate({3.3f, 1.7f}));
    std::vector<float> pixels;
    for (const PointTrack& track : plate.tracks().Of(1)) {
      pixels.push_back(track.pixel.x());
      pixels.push_back(track.pixel.y());
    }
    return pixels;
  };
  EXPECT_EQ(follow(1), follow(4));
}

}  // namespace
}  // namespace splitfusion
