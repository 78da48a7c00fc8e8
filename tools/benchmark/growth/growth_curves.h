#ifndef SPLITFUSION_TOOLS_BENCHMARK_GROWTH_GROWTH_CURVES_H_
#define SPLITFUSION_TOOLS_BENCHMARK_GROWTH_GROWTH_CURVES_H_

#include <vector>

#include "growth_table.h"

namespace splitfusion {

/// How far the curves go.
struct GrowthSizes {
  /// Of the deformation graph, at `points_per_node`.
  std::vector<int> nodes = {100, 200, 400, 800, 1600, 4000};
  /// Correspondences a node while the nodes grow.
  int points_per_node = 75;
  /// Correspondences of a graph of `fixed_nodes`.
  std::vector<int> points = {5000, 10000, 20000, 50000, 100000, 200000};
  /// Nodes while the correspondences grow.
  int fixed_nodes = 400;
  /// Metres.
  std::vector<double> voxels = {0.010, 0.008, 0.006, 0.005, 0.004, 0.003};
  /// In the room, at most PeopleScene::kMost.
  std::vector<int> people = {0, 1, 2, 3, 4};
  int frames = 16;          ///< Of the whole method for every number of people.
  int height = 480;         ///< Of the images, pixels; 4:3.
  int run_height = 240;     ///< Of the images of the whole method, pixels.
  double spacing = 0.04;    ///< Of the nodes over room and people, metres.
  double voxel_factor = 1;  ///< Of the voxels of room and people there.
  int runs =
      3;  ///< Of the whole method, of which every frame's fastest counts.
  int repetitions = 5;  ///< Of which the fastest counts.

  /// Tiny sizes: everything once, in seconds.
  static GrowthSizes Quick();
};

/// One Gauss-Newton iteration of each solver against graph nodes.
GrowthTable NodesCurve(const GrowthSizes& sizes);

/// The same against correspondences.
GrowthTable CorrespondencesCurve(const GrowthSizes& sizes);

/// Fusion, re-meshing and ray casting of one frame against the voxel size.
GrowthTable VoxelsCurve(const GrowthSizes& sizes);

/// A frame of the whole method and its parts against the people in the room.
GrowthTable PeopleCurve(const GrowthSizes& sizes);

/// The room and two people as one deformation graph and as split surfaces.
GrowthTable OneGraphTable(const GrowthSizes& sizes);

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_GROWTH_GROWTH_CURVES_H_
