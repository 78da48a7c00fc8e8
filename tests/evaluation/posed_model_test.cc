#include "splitfusion/lib/evaluation/posed_model.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

constexpr double kFocal = 100;

PinholeCamera Camera() { return {101, 101, kFocal, kFocal, 50, 50}; }

/// A square of 0.2 x 0.2 m across the optical axis at depth z, of triangles
/// with legs of 2 cm, that faces the camera.
TriangleMesh Plane(float z) {
  constexpr int kSteps = 10;
  TriangleMesh mesh;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      mesh.vertices.emplace_back(-0.1f + 0.02f * i, -0.1f + 0.02f * j, z);
      if (i == 0 || j == 0) continue;
      const int here = j * (kSteps + 1) + i;
      const int above = here - kSteps - 1;
      mesh.triangles.emplace_back(above - 1, here - 1, above);
      mesh.triangles.emplace_back(above, here - 1, here);
    }
  }
  return mesh;
}

cv::Mat_<float> Live(float z) { return cv::Mat_<float>(101, 101, z); }

TEST(MeasureStray, CountsWhatLiesBehindTheLiveDepth) {
  for (const auto& [live, share] : {std::pair{1.0f, 0.0},
                                    {0.99f, 0.0},
                                    {0.95f, 1.0},
                                    {0.8f, 0.0},
                                    {1.1f, 0.0}}) {
    const StrayArea area = MeasureStray(Plane(1), Camera(), Live(live));
    EXPECT_NEAR(area.in_view, 0.04, 1e-6);
    EXPECT_NEAR(area.Share(), share, 1e-6) << live;
  }
  // Half of the image is nearer.
  cv::Mat_<float> live = Live(1);
  live.colRange(0, 50).setTo(0.95f);
  EXPECT_NEAR(MeasureStray(Plane(1), Camera(), live).Share(), 0.5, 0.06);
}

TEST(MeasureStray, LeavesOutWhatIsNotInView) {
  TriangleMesh away = Plane(1);
  for (Eigen::Vector3i& t : away.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(MeasureStray(away, Camera(), Live(0.95f)).in_view, 0);
  EXPECT_EQ(MeasureStray(Plane(1), Camera(), Live(0)).in_view, 0);
  TriangleMesh beside = Plane(1);
  for (Eigen::Vector3f& v : beside.vertices) v.x() += 2;
  EXPECT_EQ(MeasureStray(beside, Camera(), Live(0.95f)).in_view, 0);
}

TEST(ShownPixels, AreThoseAtTheLiveDepth) {
  // 0.2 m at 1 m are 20 pixels; the mask grows by two on either side.
  const int shown = cv::countNonZero(ShownPixels(Plane(1), Camera(), Live(1)));
  EXPECT_EQ(shown, 25 * 25);
  EXPECT_EQ(cv::countNonZero(ShownPixels(Plane(1), Camera(), Live(1.06f))), 0);
  EXPECT_EQ(cv::countNonZero(ShownPixels({}, Camera(), Live(1))), 0);
}

TEST(ShownPixels, HaveNoHolesInLargeTriangles) {
  TriangleMesh mesh;
  mesh.vertices = {{-0.2f, -0.2f, 1}, {0.2f, -0.2f, 1}, {-0.2f, 0.2f, 1}};
  mesh.triangles = {{0, 2, 1}};
  const cv::Mat shown = ShownPixels(mesh, Camera(), Live(1));
  EXPECT_EQ(shown.at<std::uint8_t>(40, 40), 255);
  // 45 x 45 pixels without the corner beyond the long edge.
  EXPECT_NEAR(cv::countNonZero(shown), 45 * 45 - 40 * 41 / 2, 20);
}

}  // namespace
}  // namespace splitfusion
