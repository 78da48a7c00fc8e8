#include "splitfusion/lib/model/canonical_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/sample_depth.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// A wall at 1.2 m of which the right half is surface 1. Its model, covered
/// with nodes, is a plate of 0.3 x 0.2 m at canonical depth 1 m.
class CanonicalPlacesTest : public ::testing::Test {
 protected:
  CanonicalPlacesTest()
      : plate_(SheetMesh(0.3, 0.2, 0.005,
                         [](double x, double y) {
                           return Eigen::Vector3d(x - 0.15, y - 0.1, 1);
                         })),
        graph_(CoverWithNodes(plate_, 0.03)),
        live_(MakeLiveView(SmallCamera(), WallDepth(SmallCamera(), 1.2),
                           PlainColor(SmallCamera(), {9, 9, 9}))) {
    ApplyRigidMotion(motion_, &graph_);
    live_.labels.colRange(80, 160).setTo(1);
  }

  CanonicalPlaces Find() const { return Find(plate_.vertices); }

  CanonicalPlaces Find(const std::vector<Eigen::Vector3f>& vertices) const {
    std::vector<Eigen::Vector3f> warped;
    for (const auto& v : vertices) warped.push_back(motion_.cast<float>() * v);
    return FindWarped(vertices, warped, std::vector<char>(vertices.size()));
  }

  CanonicalPlaces FindWarped(const std::vector<Eigen::Vector3f>& vertices,
                             const std::vector<Eigen::Vector3f>& warped,
                             const std::vector<char>& confirmed) const {
    return FindCanonicalPlaces(live_, 1, graph_, {vertices, warped, confirmed},
                               limits_);
  }

  /// Expects that exactly the live points that are near any vertex at all are
  /// modelled, at the nearest one; gives their number.
  int ExpectNearestOfAll(const std::vector<Eigen::Vector3f>& vertices) const {
    const CanonicalPlaces found = Find(vertices);
    std::vector<Eigen::Vector3d> warped;
    for (const auto& v : vertices) warped.push_back(motion_ * v.cast<double>());
    int modelled = 0;
    for (int v = 0; v < 120; v += 2) {
      for (int u = 80; u < 160; u += 2) {
        double nearest = 1e9;
        for (const Eigen::Vector3d& p : warped) {
          nearest = std::min(nearest, (p - Live(u, v)).norm());
        }
        if (std::abs(nearest - limits_.mesh) < 1e-5) continue;  // Rounding.
        const bool near = nearest < limits_.mesh;
        EXPECT_EQ(near, IsModelled(found, u, v)) << u << " " << v;
        if (!near) continue;
        const cv::Vec3f& at = found.points(v, u);
        const Eigen::Vector3d place(at[0], at[1], at[2]);
        EXPECT_NEAR((motion_ * place - Live(u, v)).norm(), nearest, 1e-5);
        ++modelled;
      }
    }
    return modelled;
  }

  static bool IsModelled(const CanonicalPlaces& found, int u, int v) {
    return found.coverage(v, u) ==
           static_cast<std::uint8_t>(Coverage::kModelled);
  }

  /// The live point that a pixel's place is that of.
  Eigen::Vector3d Live(int u, int v) const {
    const cv::Vec3f& p = live_.map.points(v & ~1, u & ~1);
    return {p[0], p[1], p[2]};
  }

  const Rigid3d motion_ = MakeMotion({0, 0, 0.4}, {0.1, 0, 0.2});
  CoverageLimits limits_ = {0.015, 0.2};
  TriangleMesh plate_;
  DeformationGraph graph_;
  LiveView live_;
};

Coverage At(const CanonicalPlaces& found, int u, int v) {
  return static_cast<Coverage>(found.coverage(v, u));
}

TEST_F(CanonicalPlacesTest, EveryPointIsCarriedBackToItsPlace) {
  const CanonicalPlaces found = Find();
  int modelled = 0, farther = 0;
  for (int v = 0; v < 120; ++v) {
    for (int u = 80; u < 160; ++u) {
      if (At(found, u, v) == Coverage::kNone) continue;
      const cv::Vec3f& p = found.points(v, u);
      const Eigen::Vector3d rest = motion_.inverse() * Live(u, v);
      const double away = (rest - Eigen::Vector3d(p[0], p[1], p[2])).norm();
      const bool is_modelled = At(found, u, v) == Coverage::kModelled;
      EXPECT_LT(away, is_modelled ? limits_.mesh : 1e-5) << u << " " << v;
      modelled += is_modelled;
      farther += !is_modelled;
    }
  }
  EXPECT_GT(modelled, 300);
  EXPECT_GT(farther, 300);
}

TEST_F(CanonicalPlacesTest, CoverageGrowsLessWithTheDistance) {
  const CanonicalPlaces found = Find();
  int count[4] = {};
  for (int v = 0; v < 120; ++v) {
    for (int u = 80; u < 160; ++u) {
      ++count[found.coverage(v, u)];
      if (At(found, u, v) == Coverage::kNone) continue;
      const Eigen::Vector3d rest = motion_.inverse() * Live(u, v);
      const double beside = std::hypot(std::max(0.0, std::abs(rest.x()) - 0.15),
                                       std::max(0.0, std::abs(rest.y()) - 0.1));
      switch (At(found, u, v)) {
        case Coverage::kModelled:
          EXPECT_LT(beside, limits_.mesh);
          break;
        case Coverage::kCarried:
          EXPECT_GT(beside, 0.012);
          EXPECT_LT(beside, limits_.reach);
          break;
        default:
          EXPECT_GT(beside, limits_.reach - graph_.node_spacing);
      }
    }
  }
  for (int kind = 1; kind < 4; ++kind) EXPECT_GT(count[kind], 20) << kind;
}

TEST_F(CanonicalPlacesTest, OtherSurfacesAndWhatIsUncertainHaveNone) {
  live_.uncertain.colRange(100, 110).setTo(255);
  live_.edges.colRange(110, 120).setTo(255);
  live_.depth.colRange(120, 130).setTo(0);
  const CanonicalPlaces found = Find();
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const bool none = u < 80 || (u >= 100 && u < 130);
      EXPECT_EQ(At(found, u, v) == Coverage::kNone, none);
      EXPECT_EQ(std::isnan(found.points(v, u)[0]), none);
    }
  }
}

TEST_F(CanonicalPlacesTest, WhatNoLivePointIsNearMakesNoDifference) {
  std::vector<Eigen::Vector3f> vertices = plate_.vertices;
  for (const Eigen::Vector3f& v : plate_.vertices) {
    vertices.push_back(v + Eigen::Vector3f(0, 0, 0.02f));  // Behind.
    vertices.push_back(v - Eigen::Vector3f(0, 0, 0.3f));   // In front.
    vertices.push_back(v + Eigen::Vector3f(5, 0, 0));      // Beside.
    vertices.push_back(v - Eigen::Vector3f(0, 0, 2.0f));   // Out of view.
  }
  EXPECT_GT(ExpectNearestOfAll(vertices), 150);
}

TEST_F(CanonicalPlacesTest, AMeshIsFoundFromFarWhenVoxelsAreCoarse) {
  // The wall is at 1.2 m: from half of that on a vertex may be near a live
  // point that is anywhere in the image.
  int modelled = 0;
  for (const double limit : {0.05, 0.2, 0.59, 0.9}) {
    limits_.mesh = limit;
    const int more = ExpectNearestOfAll(plate_.vertices);
    EXPECT_GT(more, modelled) << limit;
    modelled = more;
  }
}

TEST_F(CanonicalPlacesTest, WhatWasConfirmedComesFirst) {
  // A smaller second sheet, canonically elsewhere, lies on the live points; the
  // first one lies 6 mm behind them.
  std::vector<Eigen::Vector3f> vertices = plate_.vertices, warped;
  for (const Eigen::Vector3f& v : plate_.vertices) {
    warped.push_back(motion_.cast<float>() * v + Eigen::Vector3f(0, 0, 0.006f));
  }
  for (const Eigen::Vector3f& v : plate_.vertices) {
    if (std::abs(v.x()) > 0.12f || std::abs(v.y()) > 0.07f) continue;
    vertices.push_back(v + Eigen::Vector3f(5, 0, 0));
    warped.push_back(motion_.cast<float>() * v);
  }
  const int first = static_cast<int>(plate_.vertices.size());
  std::vector<char> confirmed(vertices.size(), true);
  const CanonicalPlaces alike = FindWarped(vertices, warped, confirmed);
  const auto count_second = [first](const CanonicalPlaces& places) {
    return std::count_if(places.shown.begin(), places.shown.end(),
                         [first](int vertex) { return vertex >= first; });
  };
  EXPECT_GT(count_second(alike), 100) << "the nearer one";
  std::fill(confirmed.begin() + first, confirmed.end(), false);
  const CanonicalPlaces found = FindWarped(vertices, warped, confirmed);
  EXPECT_EQ(count_second(found), 0);
  EXPECT_GT(found.shown.size(), 150u);
  EXPECT_TRUE(std::is_sorted(found.shown.begin(), found.shown.end()));
  for (int v = 0; v < 120; ++v) {
    for (int u = 80; u < 160; ++u) {
      if (!IsModelled(found, u, v)) continue;
      EXPECT_LT(found.points(v, u)[0], 1);
    }
  }
  // Where the first one is not, the second one is.
  for (int i = 0; i < first; ++i) warped[i].z() += 0.02f;
  EXPECT_GE(count_second(FindWarped(vertices, warped, confirmed)),
            count_second(alike));
}

TEST_F(CanonicalPlacesTest, WithoutAMeshNodesCarryEverything) {
  const CanonicalPlaces found = Find({});
  EXPECT_EQ(
      cv::countNonZero(found.coverage == static_cast<int>(Coverage::kModelled)),
      0);
  EXPECT_GT(
      cv::countNonZero(found.coverage == static_cast<int>(Coverage::kCarried)),
      300);
}

}  // namespace
}  // namespace splitfusion
