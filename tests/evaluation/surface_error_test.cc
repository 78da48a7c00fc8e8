#include "splitfusion/lib/evaluation/surface_error.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/evaluation/mean_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// Rectangle [0, width] x [0, 1] at a height, two triangles.
TriangleMesh Rectangle(float width, float z) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, z}, {width, 0, z}, {width, 1, z}, {0, 1, z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

SurfaceErrorOptions FewSamples() {
  SurfaceErrorOptions options;
  options.samples = 20000;
  return options;
}

TEST(CompareSurfaces, ParallelPlanesAreTheirDistanceApart) {
  const SurfaceError error = CompareSurfaces(
      Rectangle(1, 0.015f), {Rectangle(1, 0), {}, {}}, FewSamples());
  for (const SurfaceDistances& d : {error.accuracy, error.completeness}) {
    EXPECT_EQ(d.statistics.count, 20000);
    EXPECT_NEAR(d.statistics.mean, 0.015, 1e-6);
    EXPECT_NEAR(d.statistics.max, 0.015, 1e-6);
    EXPECT_EQ(d.within[0], 0);
    EXPECT_EQ(d.within[1], 1);
  }
  EXPECT_EQ(error.f_score[0], 0);
  EXPECT_EQ(error.f_score[1], 1);
}

TEST(CompareSurfaces, HalfASurfaceIsAccurateButIncomplete) {
  const SurfaceError error = CompareSurfaces(
      Rectangle(0.5f, 0), {Rectangle(1, 0), {}, {}}, FewSamples());
  EXPECT_NEAR(error.accuracy.statistics.max, 0, 1e-6);
  EXPECT_NEAR(error.completeness.within[0], 0.51, 0.01);
  EXPECT_NEAR(error.f_score[0], 2 * 0.51 / 1.51, 0.01);
  // Distances beyond 0.3 m are clipped: the farthest would be 0.5 m.
  EXPECT_FLOAT_EQ(error.completeness.statistics.max, 0.3);
  // Mean over x of min(max(x - 0.5, 0), 0.3).
  EXPECT_NEAR(error.completeness.statistics.mean, 0.105, 0.002);
}

TEST(CompareSurfaces, SeenRestrictsCompletenessAndLabelBoth) {
  // The truth: the rectangle [0, 1] and another one that is 1 m above.
  TrueSurface truth;
  truth.mesh = Rectangle(1, 0);
  const TriangleMesh above = Rectangle(1, 1);
  truth.mesh.vertices.insert(truth.mesh.vertices.end(), above.vertices.begin(),
                             above.vertices.end());
  truth.mesh.triangles.emplace_back(4, 5, 6);
  truth.mesh.triangles.emplace_back(4, 6, 7);
  truth.seen = {9, 9, 9, 9, 0, 0, 0, 0};
  truth.label = {0, 0, 0, 0, 5, 5, 5, 5};
  SurfaceErrorOptions options = FewSamples();
  EXPECT_EQ(CompareSurfaces(Rectangle(1, 0), truth, options).f_score[0], 1);
  options.min_seen = 0;
  EXPECT_NEAR(
      CompareSurfaces(Rectangle(1, 0), truth, options).completeness.within[0],
      0.5, 0.01);
  options.label = 0;
  EXPECT_EQ(CompareSurfaces(Rectangle(1, 0), truth, options).f_score[0], 1);
  options.label = 5;
  EXPECT_EQ(CompareSurfaces(Rectangle(1, 0), truth, options).f_score[0], 0);
  options.label = 7;  // Nothing has it.
  EXPECT_EQ(CompareSurfaces(Rectangle(1, 0), truth, options)
                .completeness.statistics.count,
            0);
}

TEST(SampleSurface, IsUniformOverTheAreaAndRepeatable) {
  TriangleMesh mesh = Rectangle(1, 0);
  mesh.vertices.push_back({0, 2, 0});
  mesh.triangles.emplace_back(3, 2, 4);  // Half as large as the rectangle.
  const auto points = SampleSurface(mesh, 30000, 4);
  int above = 0;
  for (const Eigen::Vector3f& p : points) above += p.y() > 1 ? 1 : 0;
  EXPECT_NEAR(above / 30000.0, 1 / 3.0, 0.01);
  EXPECT_EQ(points, SampleSurface(mesh, 30000, 4));
  EXPECT_NE(points, SampleSurface(mesh, 30000, 5));
}

TEST(SampleSurface, TakesTheVerticesOfACloud) {
  TriangleMesh cloud;
  cloud.vertices = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}};
  EXPECT_EQ(SampleSurface(cloud, 100, 1).size(), 3u);
  EXPECT_EQ(SampleSurface(cloud, 2, 1).size(), 2u);
  const auto distances = DistancesToSurface({{0, 0.1f, 1}}, cloud, 0.3);
  EXPECT_NEAR(distances[0], 0.1, 1e-6);
}

TEST(CompareSurfaces, AnEmptyReconstructionIsNowhereComplete) {
  const SurfaceError error =
      CompareSurfaces({}, {Rectangle(1, 0), {}, {}}, FewSamples());
  EXPECT_EQ(error.accuracy.statistics.count, 0);
  EXPECT_FLOAT_EQ(error.completeness.statistics.median, 0.3);
  EXPECT_EQ(error.f_score[2], 0);
}

TEST(ReadTrueSurface, ReadsSeenAndLabelAndRejectsNothing) {
  const TemporaryFolder folder;
  const std::string head = "ply\nformat ascii 1.0\nelement vertex ";
  const std::string rest =
      "\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar seen\nproperty uchar label\nend_header\n";
  const TrueSurface surface =
      ReadTrueSurface(folder.Write("a.ply", head + "1" + rest + "1 2 3 4 5\n"));
  EXPECT_EQ(surface.seen, std::vector<double>{4});
  EXPECT_EQ(surface.label, std::vector<double>{5});
  EXPECT_THROW(ReadTrueSurface(folder.Write("b.ply", head + "0" + rest)),
               InputError);
}

TEST(MeanOf, WeighsComparisonsEqually) {
  SurfaceDistances a;
  a.statistics = {10, 1, 2, 3, 4, 5};
  a.within = {0, 0.5, 1};
  SurfaceDistances b;
  b.statistics = {30, 3, 4, 5, 6, 3};
  b.within = {1, 1, 1};
  const SurfaceDistances mean = MeanOf(std::vector<SurfaceDistances>{a, b});
  EXPECT_EQ(mean.statistics.count, 40);
  EXPECT_DOUBLE_EQ(mean.statistics.mean, 3);
  EXPECT_DOUBLE_EQ(mean.statistics.max, 5);
  EXPECT_DOUBLE_EQ(mean.within[1], 0.75);
}

}  // namespace
}  // namespace splitfusion
