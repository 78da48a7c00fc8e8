#ifndef SPLITFUSION_LIB_ENERGY_WARPED_POINTS_H_
#define SPLITFUSION_LIB_ENERGY_WARPED_POINTS_H_

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/energy/warp_functor.h"
#include "splitfusion/lib/energy/warp_kernels.h"

namespace splitfusion {

/// The node of the graph under `twist` = [omega (rad), tau (m)]. exp and its
/// derivative are Ceres' AngleAxisToRotationMatrix, over Jets of three.
TwistedNode TwistNode(const DeformationGraph& graph, int node,
                      const double* twist);

/// Model points in groups that are carried by the same nodes: what is common to
/// all residuals of warped points (Eq. 2), whatever their functor.
///
///   x = sum_k w_k [ p_k + offset_k ],
///   dx/d[omega_k, tau_k] = w_k [-[p_k] J | 1]
class WarpedPoints {
 public:
  /// Points of one group, adjacent in the order of the class.
  struct Group {
    int begin = 0;                    ///< First point.
    int end = 0;                      ///< Past the last point.
    const int* nodes = nullptr;       ///< Their nodes, ascending.
    int node_count = 0;               ///< Number of nodes.
    const double* points = nullptr;   ///< All x, all y, all z; canonical.
    const double* weights = nullptr;  ///< w of all points, by node.
  };

  /// Most points of a group: bounds the memory of one evaluation.
  static constexpr int kMaxGroupSize = 512;  // Speed.

  /// Sorts the samples; nothing of them is kept.
  explicit WarpedPoints(const std::vector<const ModelSample*>& samples);
  WarpedPoints(const WarpedPoints&) = delete;             ///< Not copied.
  WarpedPoints& operator=(const WarpedPoints&) = delete;  ///< Not copied.

  /// Number of points.
  int size() const { return static_cast<int>(source_.size()); }
  /// Groups, ascending by their lists of nodes.
  const std::vector<Group>& groups() const { return groups_; }
  /// For every point, in the order of the class, its place among the samples.
  const std::vector<int>& source() const { return source_; }

  /// Whether they still are the points of these samples, whose memory a term
  /// may have given back.
  bool AreOf(const std::vector<const ModelSample*>& samples) const;

  /// Points begin..end of a group, at most kWarpedChunk, for the kernels;
  /// `nodes`: the group's nodes in order.
  static PointChunk Chunk(const Group& group, int begin, int end,
                          const TwistedNode* const* nodes);

 private:
  void FillGroup(const std::vector<const ModelSample*>& samples,
                 const Group& group, double* points, double* weights) const;

  std::vector<int> source_;
  std::vector<double> points_;   // By group and coordinate.
  std::vector<double> weights_;  // By group and node.
  std::vector<int> nodes_;       // By group.
  std::vector<Group> groups_;
};

/// The nodes of a residual, for messages: "3 7".
std::string NodesText(const int* nodes, std::size_t count);

/// @throw InputError unless there is one and all are below `end`, not below 0.
void CheckNodes(const int* nodes, std::size_t count, int end);

/// The points of a problem's terms: terms of the same samples share them.
class WarpedPointsCache {
 public:
  /// `nodes`: number of the graph's.
  explicit WarpedPointsCache(int nodes = std::numeric_limits<int>::max())
      : nodes_(nodes) {}

  /// Number of the graph's nodes.
  int nodes() const { return nodes_; }

  /// Points of these samples, made or found.
  ///
  /// @throw InputError unless every sample is carried by nodes of the graph,
  ///     ascending.
  std::shared_ptr<const WarpedPoints> Get(
      const std::vector<const ModelSample*>& samples);

 private:
  std::vector<std::pair<std::vector<const ModelSample*>,
                        std::shared_ptr<const WarpedPoints>>>
      entries_;
  int nodes_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_WARPED_POINTS_H_
