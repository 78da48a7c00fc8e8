#include "splitfusion/lib/tsdf/check_observation.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/tsdf/warped_integration.h"
#include "support/expect_input_error.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

const TsdfOptions kCheckedOptions = {0.01, 0.04, 64};

TsdfOptions WithoutColor() {
  TsdfOptions options = kCheckedOptions;
  options.has_color = false;
  return options;
}

DepthObservation Wall() {
  return ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1));
}

TEST(CheckObservation, AllImagesHaveTheCamerasSize) {
  CheckObservation(Wall(), kCheckedOptions);
  const cv::Size half(80, 120);
  const auto expect_refused = [&](const char* name,
                                  auto DepthObservation::*image) {
    DepthObservation observation = Wall();
    (observation.*image).create(half);
    ExpectInputError(
        [&] { CheckObservation(observation, WithoutColor()); },
        std::string(name) + " image is 80x120: expected 160x120, the camera's");
  };
  expect_refused("depth", &DepthObservation::depth);
  expect_refused("weight", &DepthObservation::weight);
  expect_refused("role", &DepthObservation::role);
  expect_refused("places", &DepthObservation::places);
}

TEST(CheckObservation, AVolumeWithColourNeedsAColourImage) {
  DepthObservation observation = Wall();
  observation.color.release();
  CheckObservation(observation, WithoutColor());
  ExpectInputError([&] { CheckObservation(observation, kCheckedOptions); },
                   "color image is 0x0: expected 160x120");
  observation.color = cv::Mat::zeros(120, 160, CV_8UC1);
  ExpectInputError([&] { CheckObservation(observation, kCheckedOptions); },
                   "color image is of type 0: expected 8UC3 (16)");
}

TEST(CheckObservation, WarpedFusionRefusesWhatIsMissing) {
  const DeformationGraph graph =
      CoverWithNodes(PlateMesh(0.1, 0.1, 0.01, 1), 0.03);
  TsdfVolume volume(kCheckedOptions);
  AllocateAround(graph.positions, 0.05, &volume);
  DepthObservation observation = Wall();
  observation.color.release();
  ExpectInputError(
      [&] {
        WarpedIntegrator().Integrate(observation, SkinningIndex(graph, 6),
                                     WarpField(graph), 0.05, &volume);
      },
      "color image is 0x0");
  EXPECT_TRUE(ExtractMesh(volume, 0.5).empty());
}

}  // namespace
}  // namespace splitfusion
