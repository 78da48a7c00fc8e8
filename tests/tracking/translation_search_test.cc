#include "splitfusion/lib/tracking/translation_search.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/deformation/deformation_graph.h"

namespace splitfusion {
namespace {

const PinholeCamera kSearchCamera{320, 240, 260, 260, 160, 120};

/// A rectangle of the image, parallel to it.
struct Plate {
  cv::Rect area;
  float depth = 0;
  std::uint8_t grey = 0;
};

/// A live view with surface 1 made of plates before a wall at 3 m.
LiveView ViewOf(const std::vector<Plate>& plates) {
  cv::Mat_<float> depth(240, 320, 3.0f);
  cv::Mat color(240, 320, CV_8UC3, cv::Scalar::all(0));
  for (const Plate& plate : plates) {
    depth(plate.area) = plate.depth;
    color(plate.area) = cv::Scalar::all(plate.grey);
  }
  LiveView live = MakeLiveView(kSearchCamera, depth, color);
  for (const Plate& plate : plates) live.labels(plate.area) = 1;
  return live;
}

/// Samples of a model made of plates, at every second pixel; canonical is
/// camera.
std::vector<ModelSample> SamplesOf(const std::vector<Plate>& plates) {
  std::vector<ModelSample> samples;
  for (const Plate& plate : plates) {
    const cv::Rect& area = plate.area;
    for (int v = area.y; v < area.br().y; v += 2) {
      for (int u = area.x; u < area.br().x; u += 2) {
        ModelSample sample;
        sample.point = kSearchCamera.BackProject<float>(
            static_cast<float>(u), static_cast<float>(v), plate.depth);
        sample.normal = -Eigen::Vector3f::UnitZ();
        const float grey = static_cast<float>(plate.grey) / 255;
        sample.intensity = {grey, grey};
        sample.u = u;
        sample.v = v;
        sample.skinning.count = 1;
        sample.skinning.weights[0] = 1;
        samples.push_back(sample);
      }
    }
  }
  return samples;
}

std::optional<Rigid3d> Find(const std::vector<Plate>& model,
                            const LiveView& live, std::uint16_t surface = 1,
                            double deviation = 0.3) {
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  return FindTranslation(SamplesOf(model), WarpField(graph), live, surface,
                         deviation);
}

TEST(FindTranslation, FindsAFarJump) {
  const auto found = Find({{{40, 64, 48, 112}, 2.0f, 100}},
                          ViewOf({{{200, 72, 48, 112}, 2.24f, 100}}));
  ASSERT_TRUE(found);
  // Pixels to metres at 2.24 m.
  EXPECT_NEAR(found->translation().x(), 160 * 2.24 / 260, 0.04);
  EXPECT_NEAR(found->translation().y(), 8 * 2.24 / 260, 0.04);
  EXPECT_NEAR(found->translation().z(), 0.24, 0.02);
}

TEST(FindTranslation, AHalfHiddenBodyIsNotPulledToItsCentroid) {
  LiveView live = ViewOf({{{120, 64, 48, 112}, 2.0f, 100}});
  const cv::Rect hiding(120, 64, 48, 56);
  live.labels(hiding) = 2;
  live.depth(hiding) = 1.5f;
  const auto found = Find({{{96, 64, 48, 112}, 2.0f, 100}}, live);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->translation().x(), 24 * 2.0 / 260, 0.04);
  // The centroid of what is seen is 28 pixels lower: 0.22 m.
  EXPECT_NEAR(found->translation().y(), 0, 0.04);
}

// Where the silhouettes overlap most, the leg covers the leg.
TEST(FindTranslation, ALegThatHasSwungDoesNotMisleadIt) {
  const Plate head = {{120, 40, 24, 24}, 2.0f, 100};
  const Plate torso = {{112, 64, 40, 60}, 2.0f, 60};
  const Plate before = {{76, 124, 40, 60}, 1.8f, 200};
  const Plate after = {{148, 124, 40, 60}, 2.2f, 200};
  const auto found = Find({head, torso, before}, ViewOf({head, torso, after}));
  ASSERT_TRUE(found);
  EXPECT_LT(found->translation().norm(), 0.04) << found->translation();
}

TEST(FindTranslation, GreyValuesTellWhereABodyIsOnALargerOne) {
  const auto found = Find(
      {{{40, 64, 40, 64}, 2.0f, 220}},
      ViewOf({{{120, 40, 160, 160}, 2.0f, 40}, {{216, 96, 40, 64}, 2.0f, 220}}),
      1, 2.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->translation().x(), 176 * 2.0 / 260, 0.04);
  EXPECT_NEAR(found->translation().y(), 32 * 2.0 / 260, 0.04);
}

// Two places look like it; the farther one shows a little more of it.
TEST(FindTranslation, AFarWayNeedsMoreThatSpeaksForIt) {
  const std::vector<Plate> model = {{{40, 64, 48, 80}, 2.0f, 100}};
  const LiveView live =
      ViewOf({{{52, 64, 48, 72}, 2.0f, 100}, {{200, 64, 48, 80}, 2.0f, 100}});
  const auto far = Find(model, live, 1, 4.0);
  ASSERT_TRUE(far);
  EXPECT_NEAR(far->translation().x(), 160 * 2.0 / 260, 0.04);
  const auto near = Find(model, live, 1, 0.2);
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->translation().x(), 12 * 2.0 / 260, 0.04);
}

// Behind itself, or less of it aside.
TEST(FindTranslation, AChangeOfDepthIsAWay) {
  const std::vector<Plate> model = {{{40, 64, 12, 80}, 2.0f, 100}};
  const LiveView live =
      ViewOf({{{40, 64, 12, 80}, 2.36f, 100}, {{68, 64, 12, 72}, 2.0f, 100}});
  const auto behind = Find(model, live, 1, 4.0);
  ASSERT_TRUE(behind);
  EXPECT_NEAR(behind->translation().z(), 0.36, 0.03);
  const auto aside = Find(model, live, 1, 0.15);
  ASSERT_TRUE(aside);
  EXPECT_NEAR(aside->translation().z(), 0, 0.03);
}

TEST(FindTranslation, SaysWhenNothingIsSeen) {
  const LiveView live = ViewOf({{{120, 64, 48, 112}, 2.0f, 100}});
  EXPECT_FALSE(Find({{{96, 64, 48, 112}, 2.0f, 100}}, live, 7));
  EXPECT_FALSE(Find({}, live));
}

}  // namespace
}  // namespace splitfusion
