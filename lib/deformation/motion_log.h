#ifndef SPLITFUSION_LIB_DEFORMATION_MOTION_LOG_H_
#define SPLITFUSION_LIB_DEFORMATION_MOTION_LOG_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/spool_file.h"
#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/motion_history.h"
#include "splitfusion/lib/deformation/node_change.h"

namespace splitfusion {

class NodeBirths;

/// Motions of a surface that is being tracked, by ascending frame, while its
/// graph grows: as MotionHistory, nodes that are born later have motions in the
/// earlier frames, too, and forgotten ones have none. The last frames lie in
/// memory, older ones in a temporary file, where they stay as they were: what
/// was born since is blended when they are read, so that neither memory nor the
/// cost of a new node grows with the frames.
class MotionLog {
 public:
  /// `file`: where frames go; `memory`: bytes that they may take before.
  explicit MotionLog(
      std::shared_ptr<SpoolFile> file = std::make_shared<SpoolFile>(),
      std::size_t memory = kMemory)
      : memory_(memory), file_(std::move(file)) {}

  /// Number of frames.
  int size() const { return spooled_ + static_cast<int>(recent_.size()); }
  /// Whether there is none.
  bool empty() const { return size() == 0; }

  /// Index of frame i, from 0 to size() - 1.
  int frame(int i) const;
  /// Whether the surface was tracked in it.
  bool tracked(int i) const;
  /// Its motions, of all nodes that there are now.
  ///
  /// @throw InputError if the file cannot be read.
  FrameMotions At(int i) const;
  /// Motions of the frame with this index; none if the surface has none for it.
  ///
  /// @throw InputError as At().
  std::optional<FrameMotions> Find(int frame) const;
  /// All frames.
  ///
  /// @throw InputError as At().
  MotionHistory All() const;

  /// Appends a frame behind all others; it has a motion of every node that
  /// there is.
  ///
  /// @throw InputError if the file cannot be written.
  void Append(FrameMotions frame);

  /// The nodes became others: `births` are new, all that `change` says applies
  /// to the frames so far.
  void Grow(const NodeBirths& births, const NodeChange& change);

  /// Sets the motions of frame i of a graph that has not grown.
  ///
  /// @throw InputError as Append().
  void Replace(int i, const std::vector<NodeMotion>& motions);

  /// That of some of the nodes (of every one whether it is), from the frame on
  /// in which the first of them was seen. It knows of its own nodes alone:
  /// before another was, it moves with the nearest one that was before it.
  ///
  /// `graph`: of these nodes, with `first_seen`, which ascends. Not of a part.
  ///
  /// @throw InputError as Append().
  MotionLog Part(const std::vector<char>& nodes,
                 const DeformationGraph& graph) const;

  /// Says that it is complete: all of it goes to the file.
  ///
  /// @throw InputError as Append().
  void Finish();

  /// Saves or restores what is known of a complete one beside its motions,
  /// which stay in the file: it is to be restored by one of the same file. See
  /// lib/base/archive.h.
  template <typename Archive>
  void SerializeIndex(Archive* archive);

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    const std::uint64_t count = archive->Count(size(), 1);
    if constexpr (Archive::kReads) *this = MotionLog(file_, memory_);
    for (std::uint64_t i = 0; i < count; ++i) {
      FrameMotions frame;
      if constexpr (!Archive::kReads) frame = At(static_cast<int>(i));
      (*archive)(frame);
      if constexpr (Archive::kReads) Append(std::move(frame));
    }
  }

 private:
  /// That of a surface.
  static constexpr std::size_t kMemory = std::size_t{16} << 20;  // Speed.

  /// A frame in the file.
  struct SpooledFrame {
    int index = 0;             ///< In the sequence.
    bool tracked = true;       ///< As FrameMotions::tracked.
    bool has_seen = false;     ///< Whether it is known what was seen.
    std::uint64_t offset = 0;  ///< Of its bytes.

    template <typename Archive>
    void Serialize(Archive* archive) {
      (*archive)(index, tracked, has_seen, offset);
    }
  };
  /// Frames in the file, of the same nodes.
  struct Block {
    std::vector<SpooledFrame> frames;                 ///< Ascending.
    std::shared_ptr<const std::vector<int>> numbers;  ///< Of the nodes then.
    /// Of a part, which knows of some of the nodes alone: indices of these in
    /// a frame, by `numbers`; else empty, as all nodes lie there in order.
    std::vector<int> places;
    int nodes = 0;       ///< In the frames.
    int nodes_ever = 0;  ///< Until then.
    int changes = 0;     ///< As `nodes_ever`.

    /// Those from a frame on, with some of the nodes alone: those with these
    /// numbers, ascending, are numbered anew from 0.
    Block Part(const std::vector<int>& chosen, int first_frame) const;
  };
  /// Nodes that were born together, some of them.
  struct Births {
    std::shared_ptr<const std::vector<int>> numbers;  ///< Ascending.
    std::shared_ptr<const NodeBirths> nodes;          ///< By `numbers`.
    /// Of a part: in frames before, they move so whatever the file has.
    int frame = 0;
  };

  static std::vector<Births> BirthsIn(const DeformationGraph& graph);
  int BlockOf(int i) const;
  const SpooledFrame& HeadOf(int i) const;
  std::vector<char> Needed() const;
  FrameMotions Load(int i) const;
  void ForgetNeedlessBirths();
  void Spool();

  std::size_t memory_;
  std::shared_ptr<SpoolFile> file_;
  std::vector<std::shared_ptr<const Block>> blocks_;
  std::vector<int> block_ends_;  // Number of frames up to their ends.
  int spooled_ = 0;
  std::deque<FrameMotions> recent_;
  std::size_t recent_bytes_ = 0;
  // Every node that there ever was has a number: those that there are now, and
  // how many there were.
  std::shared_ptr<const std::vector<int>> numbers_;
  int nodes_ever_ = 0;
  std::vector<Births> births_;  // On which those that there are now depend.
  int changes_ = 0;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_MOTION_LOG_H_
