#include "splitfusion/lib/visibility/seen_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

constexpr double kSpacing = 0.04;

/// A plate of which the left half was seen in frame 3, all of it in frame 8.
class SeenTrianglesTest : public ::testing::Test {
 protected:
  SeenTrianglesTest() {
    for (const Eigen::Vector3d& g : graph_.positions) {
      graph_.first_seen.push_back(IsLeft(g) ? 3 : 8);
    }
    skinning_ = SkinningIndex(graph_, 6).Skin(mesh_.vertices);
  }

  static bool IsLeft(const Eigen::Vector3d& node) { return node.x() < 0.3; }

  std::vector<Eigen::Vector3i> SeenIn(int frame) const {
    return SeenTriangles(mesh_, skinning_, graph_, frame);
  }

  /// Of a vertex from the nearest node that is in the left half (or in the
  /// right one), metres.
  double DistanceFrom(bool left, int vertex) const {
    double nearest = 1;
    for (const Eigen::Vector3d& g : graph_.positions) {
      if (IsLeft(g) != left) continue;
      nearest =
          std::min(nearest, (g - mesh_.vertices[vertex].cast<double>()).norm());
    }
    return nearest;
  }

  /// Triangles of which every corner is nearest to a node of the left half or
  /// no farther from one than the spacing.
  std::vector<Eigen::Vector3i> LeftHalf() const {
    std::vector<Eigen::Vector3i> triangles;
    for (const Eigen::Vector3i& t : mesh_.triangles) {
      const auto is_left = [&](int vertex) {
        const double distance = DistanceFrom(true, vertex);
        return distance < kSpacing || distance < DistanceFrom(false, vertex);
      };
      if (is_left(t[0]) && is_left(t[1]) && is_left(t[2])) {
        triangles.push_back(t);
      }
    }
    return triangles;
  }

  TriangleMesh mesh_ = PlateMesh(0.6, 0.3, 0.013, 1);
  DeformationGraph graph_ = CoverWithNodes(mesh_, kSpacing);
  std::vector<Skinning> skinning_;
};

TEST_F(SeenTrianglesTest, AreNoneBeforeTheFirstFrame) {
  EXPECT_TRUE(SeenIn(2).empty());
}

TEST_F(SeenTrianglesTest, AreThoseNearNodesThatWereSeen) {
  for (const int frame : {3, 7}) {
    const std::vector<Eigen::Vector3i> seen = SeenIn(frame);
    EXPECT_EQ(seen, LeftHalf()) << frame;
    EXPECT_GT(seen.size(), 0.45 * mesh_.triangles.size());
    EXPECT_LT(seen.size(), 0.65 * mesh_.triangles.size());
  }
}

TEST_F(SeenTrianglesTest, MayLieInOneNodeAlone) {
  DeformationGraph rigid = MakeRigidGraph(Rigid3d::Identity());
  rigid.first_seen = {3};
  const auto skinning = SkinningIndex(rigid, 6).Skin(mesh_.vertices);
  EXPECT_TRUE(SeenTriangles(mesh_, skinning, rigid, 2).empty());
  EXPECT_EQ(SeenTriangles(mesh_, skinning, rigid, 3), mesh_.triangles);
}

TEST_F(SeenTrianglesTest, AreAllOnceEveryNodeWasSeen) {
  EXPECT_EQ(SeenIn(8), mesh_.triangles);
  EXPECT_EQ(SeenIn(100), mesh_.triangles);
}

TEST_F(SeenTrianglesTest, AreAllWhereNothingIsRecorded) {
  graph_.first_seen.clear();
  EXPECT_EQ(SeenIn(0), mesh_.triangles);
}

}  // namespace
}  // namespace splitfusion
