#ifndef SPLITFUSION_LIB_DEFORMATION_MOTION_HISTORY_H_
#define SPLITFUSION_LIB_DEFORMATION_MOTION_HISTORY_H_

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"

namespace splitfusion {

template <typename T>
class SpooledList;

/// Nodes that follow one another.
struct NodeRange {
  int begin = 0;  ///< Index of the first one.
  int end = 0;    ///< Index behind the last one.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(begin, end);
  }
};

/// Motions of the nodes of one surface in one frame, camera from canonical: of
/// all of them, or of those that are in use.
struct FrameMotions {
  int frame = 0;        ///< Frame index.
  bool tracked = true;  ///< False if the motion was carried over (lost frame or
                        ///< surface out of view).
  std::vector<NodeMotion> motions;  ///< Per node of `ranges`.
  /// As `motions`, whether live depth showed the surface where the node was; of
  /// nodes that were born later it did not. Nodes without an entry were not
  /// seen.
  std::vector<char> seen = {};
  /// Which nodes these are of, ascending and apart; empty: of all.
  std::vector<NodeRange> ranges = {};

  /// Where a node is in `motions`; -1: it has none.
  int IndexOf(int node) const;

  /// Its motion. It must have one.
  const NodeMotion& Of(int node) const { return motions[IndexOf(node)]; }

  /// Whether a node was seen.
  bool Saw(int node) const {
    const int index = IndexOf(node);
    return index >= 0 && index < static_cast<int>(seen.size()) &&
           seen[index] != 0;
  }

  /// What it takes of memory.
  std::size_t bytes() const;

  /// Sets the motions of those nodes that have one here, of all that there are.
  void SpreadTo(std::vector<NodeMotion>* all) const;

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(frame, tracked, motions, seen, ranges);
  }
};

/// Motions of one surface through time, by ascending frame. Nodes born later
/// have motions in the earlier frames too (blended from the nodes that existed
/// then), so that every vertex of the final model can be carried to every
/// frame since the surface's birth. Long ones do not fill the memory: what is
/// more than it may take lies in a temporary file.
class MotionHistory {
 public:
  /// Goes over the frames.
  class Iterator {
   public:
    /// Frame `i` of a history, which must outlive this.
    Iterator(const MotionHistory* history, int i) : history_(history), i_(i) {}

    /// The frame.
    FrameMotions operator*() const { return history_->At(i_); }
    /// Goes to the next one.
    Iterator& operator++() {
      ++i_;
      return *this;
    }
    /// Whether it is another one of the same history.
    bool operator!=(const Iterator& other) const { return i_ != other.i_; }

   private:
    const MotionHistory* history_;
    int i_;
  };

  /// Of no frame yet.
  MotionHistory() : MotionHistory(kMemory) {}
  /// `memory`: bytes of motions that lie in memory.
  explicit MotionHistory(std::size_t memory);

  /// Number of frames.
  int size() const { return static_cast<int>(places_.size()); }
  /// Whether there is none.
  bool empty() const { return places_.empty(); }
  /// Index of frame i, 0 to size() - 1, in the sequence.
  int frame(int i) const { return places_[i].frame; }

  /// Motions of frame i.
  ///
  /// @throw InputError if the file cannot be read.
  FrameMotions At(int i) const;
  /// Whether there is a frame with this index.
  bool Has(int frame) const { return IndexOf(frame) >= 0; }
  /// Whether there is one in which the surface was tracked.
  bool Tracked(int frame) const {
    const int i = IndexOf(frame);
    return i >= 0 && places_[i].tracked;
  }
  /// Motions of the frame with this index; none if the surface has none for it.
  ///
  /// @throw InputError as At().
  std::optional<FrameMotions> Find(int frame) const;
  /// All frames, as At().
  Iterator begin() const { return {this, 0}; }
  /// Behind the last one.
  Iterator end() const { return {this, size()}; }

  /// Appends a frame behind all others.
  ///
  /// @throw InputError if the file cannot be written.
  void Append(FrameMotions frame);
  /// Takes the place of the frame with the same index, which must be there.
  ///
  /// @throw InputError as Append().
  void Replace(FrameMotions frame);

 private:
  static constexpr std::size_t kMemory = std::size_t{16} << 20;  // Speed.

  /// Where a frame lies.
  struct Place {
    int frame = 0;                               ///< Index.
    bool tracked = true;                         ///< As FrameMotions::tracked.
    std::shared_ptr<const FrameMotions> memory;  ///< Null: in the file.
    int spooled = 0;                             ///< Index there.
  };

  int IndexOf(int frame) const;
  void Put(FrameMotions frame, Place* place);

  std::size_t memory_;
  std::size_t used_ = 0;  // Bytes of it.
  std::vector<Place> places_;
  std::shared_ptr<SpooledList<FrameMotions>> spooled_;  // Of copies, too.
};

/// Motions of the nodes of a graph at the ends of the parts that they are of,
/// see DeformationGraph::parts; where there are no parts, none.
struct PartEnds {
  std::vector<NodeMotion> first;  ///< In the first frame of the part.
  std::vector<NodeMotion> last;   ///< In its last one.
};

/// Those of the graph of a history.
///
/// @throw InputError as MotionHistory::At().
PartEnds EndsOfParts(const MotionHistory& history,
                     const DeformationGraph& graph);

/// Motions of all nodes of a graph in a frame that the history has; nodes that
/// are not in use then have the nearest one that they had. `ends`:
/// EndsOfParts().
///
/// @throw InputError as MotionHistory::At().
std::vector<NodeMotion> MotionsOfAll(const MotionHistory& history,
                                     const DeformationGraph& graph,
                                     const PartEnds& ends, int frame);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_MOTION_HISTORY_H_
