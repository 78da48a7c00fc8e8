#include "splitfusion/lib/tsdf/forget_voxels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "splitfusion/lib/tsdf/mesh_extractor.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

using Place = std::array<float, 3>;

std::set<Place> PlacesOf(const TriangleMesh& mesh) {
  std::set<Place> places;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    places.insert({v.x(), v.y(), v.z()});
  }
  return places;
}

/// A wall at 1 m.
TsdfVolume WallVolume() {
  const DepthObservation wall =
      ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1.0));
  TsdfVolume volume({0.01, 0.04, 64});
  AllocateBand(wall, Rigid3d::Identity(), &volume);
  IntegrateRigid(wall, Rigid3d::Identity(), &volume);
  return volume;
}

TEST(ForgetVoxels, LeavesThoseOfOtherNodes) {
  TsdfVolume volume = WallVolume();
  MeshExtractor extractor;
  const TriangleMesh before = extractor.Extract(volume, 0.1);
  const DeformationGraph graph = CoverWithNodes(before, 0.05);
  const SkinningIndex index(graph, 4);
  std::vector<char> nodes(graph.size());
  for (int i = 0; i < graph.size(); ++i) {
    nodes[i] = graph.positions[i].head<2>().norm() < 0.15;
  }
  ForgetVoxels(graph, index, nodes, &volume);
  const TriangleMesh after = extractor.Extract(volume, 0.1);
  ASSERT_LT(after.vertices.size(), before.vertices.size());
  for (const Eigen::Vector3f& v : after.vertices) {
    float distance = 0;
    const int node = index.NearestNode(v, &distance);
    EXPECT_EQ(nodes[node], 0);
  }
  // What stays is as it was, but for the border.
  const std::set<Place> kept = PlacesOf(after);
  int lost = 0, forgotten = 0;
  for (const Eigen::Vector3f& v : before.vertices) {
    const bool is_there = kept.count({v.x(), v.y(), v.z()}) > 0;
    const bool is_forgotten = nodes[index.NearestNode(v, nullptr)] != 0;
    forgotten += is_forgotten;
    lost += !is_there && !is_forgotten;
  }
  EXPECT_GT(forgotten, 300);
  EXPECT_LT(lost, forgotten / 2);
  EXPECT_EQ(PlacesOf(ExtractMesh(volume, 0.1)), kept);
}

TEST(ForgetAround, LeavesWhatIsFartherAway) {
  TsdfVolume volume = WallVolume();
  MeshExtractor extractor;
  const TriangleMesh before = extractor.Extract(volume, 0.1);
  const std::vector<Eigen::Vector3f> places = {{0, 0, 1}, {0.2f, 0, 1}};
  const auto distance = [&](const Eigen::Vector3f& v) {
    return std::min((v - places[0]).norm(), (v - places[1]).norm());
  };
  ForgetAround(places, 0.1, &volume);
  const std::set<Place> after = PlacesOf(extractor.Extract(volume, 0.1));
  int gone = 0;
  for (const Eigen::Vector3f& v : before.vertices) {
    const bool is_there = after.count({v.x(), v.y(), v.z()}) > 0;
    gone += !is_there;
    // A cell needs all of its voxels.
    EXPECT_FALSE(is_there && distance(v) < 0.1);
    EXPECT_TRUE(is_there || distance(v) < 0.12);
  }
  EXPECT_GT(gone, 300);
  ForgetAround({}, 0.1, &volume);
  EXPECT_EQ(PlacesOf(ExtractMesh(volume, 0.1)), after);
}

TEST(ForgetVoxels, OfNoNodesChangesNothing) {
  TsdfVolume volume = WallVolume();
  const TriangleMesh before = ExtractMesh(volume, 0.1);
  const DeformationGraph graph = CoverWithNodes(before, 0.05);
  ForgetVoxels(graph, SkinningIndex(graph, 4),
               std::vector<char>(graph.size(), false), &volume);
  EXPECT_EQ(ExtractMesh(volume, 0.1).vertices, before.vertices);
}

}  // namespace
}  // namespace splitfusion
