#ifndef SPLITFUSION_LIB_MODEL_PART_MOTIONS_H_
#define SPLITFUSION_LIB_MODEL_PART_MOTIONS_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <vector>

#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/model/surface_model.h"

namespace splitfusion {

/// One part of a surface through the frames in which it is in use, in the
/// world, for RefineHiddenMotions(). A whole recording would fill the memory:
/// states are there of the frames in hand.
struct PartMotions {
  /// Where a node is in a frame.
  struct State {
    Eigen::Vector3d place;     ///< Of its centre, metres.
    Eigen::Matrix3d rotation;  ///< World from canonical.
  };

  /// Number of frames.
  int frames() const { return static_cast<int>(indices.size()); }
  /// Number of nodes.
  int nodes() const { return static_cast<int>(rest.size()); }
  /// Whether anything is sought in frames [begin, end).
  bool HasHidden(int begin, int end) const;

  int part = 0;                             ///< Index among the graph's.
  int first_node = 0;                       ///< Likewise.
  std::vector<Eigen::Vector3d> rest;        ///< Places, canonical.
  std::vector<std::vector<int>> neighbors;  ///< By their number in the part.
  std::vector<int> indices;                 ///< Of the frames.
  /// By frame, then node, whether its motion is sought.
  std::vector<std::vector<char>> hidden;
  /// By frame, then node; of a frame that is not in hand, none.
  std::vector<std::vector<State>> states;
  int first_in_hand = 0;  ///< No frame before this one is.
};

/// Where the centres of nodes are, canonical, metres: that of a rigid surface
/// amid its mesh.
std::vector<Eigen::Vector3d> CentersOf(const SurfaceModel& model);

/// Brings the frames of a part of a model in hand. Sought are the motions of
/// nodes between two sights, and of all between two sights of the part. They
/// begin with the way and the turn with which a node comes into sight again
/// spread over the frames in which it was hidden.
class PartFrames {
 public:
  /// `part`: 0..max(1, parts) - 1. `centers`: CentersOf(). `world_from_camera`:
  /// by frame index, of all frames of the history. All of them must outlive
  /// this.
  ///
  /// @throw InputError as MotionHistory::At().
  PartFrames(std::size_t part, const std::vector<Eigen::Vector3d>& centers,
             const std::map<int, Rigid3d>& world_from_camera,
             const SurfaceModel& model);

  /// What is known of the part, with no frame in hand.
  const PartMotions& motions() const { return motions_; }

  /// Brings frames [begin, end) in hand, where they are not yet, and lets go of
  /// those before.
  ///
  /// @throw InputError as MotionHistory::At().
  void Load(int begin, int end, PartMotions* motions) const;

 private:
  /// Frames, by number in the part, between two in which a node was known, and
  /// how it came into sight again.
  struct Stretch {
    int last;                // In which it was known before.
    int next;                // Likewise after.
    Eigen::Vector3d way;     // Metres.
    Eigen::AngleAxisd turn;  // World.
  };

  std::vector<PartMotions::State> Tracked(int f) const;
  void Spread(int f, std::vector<PartMotions::State>* states) const;
  void FindStretches();

  const std::vector<Eigen::Vector3d>& centers_;
  const std::map<int, Rigid3d>& world_from_camera_;
  const SurfaceModel& model_;
  PartMotions motions_;
  std::vector<std::vector<Stretch>> stretches_;  // By node, in time.
};

/// Puts what was sought in frames [begin, end) into the history; the other
/// nodes keep their bits.
///
/// @throw InputError as MotionHistory::Replace().
void StoreMotions(const PartMotions& motions, int begin, int end,
                  const std::map<int, Rigid3d>& world_from_camera,
                  SurfaceModel* model);

/// Of every part of a graph whether it was refuted: it ended while what follows
/// went on. One after which nothing goes on that was there before was a whole
/// model, which ended as its surface was re-anchored.
std::vector<char> WhichWereRefuted(const DeformationGraph& graph);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_PART_MOTIONS_H_
