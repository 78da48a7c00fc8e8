#include "splitfusion/lib/deformation/motion_log.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <iterator>
#include <numeric>
#include <utility>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/base/chosen.h"
#include "splitfusion/lib/deformation/node_births.h"
#include "splitfusion/lib/deformation/skinning.h"

namespace splitfusion {
namespace {

/// Frames that go to the file together.
constexpr std::size_t kBlockFrames = 16;  // Speed.

/// In the file a motion is R column by column, then t; what was seen follows
/// all of them.
using SpooledMotion = std::array<double, 12>;

std::vector<char> BytesOfFrame(const FrameMotions& frame) {
  std::vector<char> bytes(frame.motions.size() * sizeof(SpooledMotion));
  char* next = bytes.data();
  for (const NodeMotion& motion : frame.motions) {
    SpooledMotion stored;
    std::copy_n(motion.rotation.data(), 9, stored.begin());
    std::copy_n(motion.translation.data(), 3, stored.begin() + 9);
    std::memcpy(next, stored.data(), sizeof(stored));
    next += sizeof(stored);
  }
  if (!frame.seen.empty()) {
    bytes.insert(bytes.end(), frame.seen.begin(), frame.seen.end());
    bytes.resize(frame.motions.size() * (sizeof(SpooledMotion) + 1), 0);
  }
  return bytes;
}

NodeMotion MotionFrom(const char* bytes) {
  SpooledMotion stored;
  std::memcpy(stored.data(), bytes, sizeof(stored));
  NodeMotion motion;
  std::copy_n(stored.begin(), 9, motion.rotation.data());
  std::copy_n(stored.begin() + 9, 3, motion.translation.data());
  return motion;
}

/// The numbers of nodes from `begin` up to the one before `end`.
std::shared_ptr<const std::vector<int>> NumbersFrom(int begin, int end) {
  std::vector<int> numbers(end - begin);
  std::iota(numbers.begin(), numbers.end(), begin);
  return std::make_shared<const std::vector<int>>(std::move(numbers));
}

}  // namespace

MotionLog::Block MotionLog::Block::Part(const std::vector<int>& chosen,
                                        int first_frame) const {
  assert(places.empty());
  Block part;
  std::copy_if(frames.begin(), frames.end(), std::back_inserter(part.frames),
               [&](const SpooledFrame& f) { return f.index >= first_frame; });
  const auto there = std::lower_bound(chosen.begin(), chosen.end(), nodes_ever);
  part.nodes_ever = static_cast<int>(there - chosen.begin());
  part.nodes = nodes;
  part.changes = changes;
  for (auto number = chosen.begin(); number != there; ++number) {
    const auto at = std::lower_bound(numbers->begin(), numbers->end(), *number);
    part.places.push_back(static_cast<int>(at - numbers->begin()));
  }
  part.numbers = NumbersFrom(0, part.nodes_ever);
  return part;
}

/// Nodes of a graph that were born later than its first ones.
std::vector<MotionLog::Births> MotionLog::BirthsIn(
    const DeformationGraph& graph) {
  std::vector<Births> all;
  DeformationGraph older;
  for (int begin = 0, end = 0; begin < graph.size(); begin = end) {
    const int frame = graph.first_seen[begin];
    std::vector<Eigen::Vector3f> places;
    for (; end < graph.size() && graph.first_seen[end] == frame; ++end) {
      places.push_back(graph.positions[end].cast<float>());
    }
    if (begin > 0) {
      all.push_back({NumbersFrom(begin, end),
                     std::make_shared<const NodeBirths>(
                         older, SkinningIndex(older, 1), std::move(places)),
                     frame});
    }
    older.positions.assign(graph.positions.begin(),
                           graph.positions.begin() + end);
    older.neighbors.resize(end);
  }
  return all;
}

int MotionLog::BlockOf(int i) const {
  return static_cast<int>(
      std::upper_bound(block_ends_.begin(), block_ends_.end(), i) -
      block_ends_.begin());
}

const MotionLog::SpooledFrame& MotionLog::HeadOf(int i) const {
  const int b = BlockOf(i);
  const std::vector<SpooledFrame>& frames = blocks_[b]->frames;
  return frames[frames.size() - (block_ends_[b] - i)];
}

int MotionLog::frame(int i) const {
  return i < spooled_ ? HeadOf(i).index : recent_[i - spooled_].frame;
}

bool MotionLog::tracked(int i) const {
  return i < spooled_ ? HeadOf(i).tracked : recent_[i - spooled_].tracked;
}

FrameMotions MotionLog::At(int i) const {
  return i < spooled_ ? Load(i) : recent_[i - spooled_];
}

/// Of every node that there ever was whether it is one of those that there are
/// now, or one of which they were blended.
std::vector<char> MotionLog::Needed() const {
  std::vector<char> needed(nodes_ever_, false);
  for (const int number : *numbers_) needed[number] = true;
  for (const Births& births : births_) {
    for (const int carrier : births.nodes->carriers()) needed[carrier] = true;
  }
  return needed;
}

FrameMotions MotionLog::Load(int i) const {
  const Block& block = *blocks_[BlockOf(i)];
  const SpooledFrame& head = HeadOf(i);
  const std::vector<int>& numbers = *block.numbers;
  const std::vector<int>& places = block.places;
  // A part's few nodes lie near each other.
  const std::size_t first = places.empty() ? 0 : places.front();
  const std::size_t count =
      (places.empty() ? block.nodes : places.back() + 1) - first;
  std::vector<char> bytes(count * sizeof(SpooledMotion));
  file_->Read(head.offset + first * sizeof(SpooledMotion), bytes.data(),
              bytes.size());
  std::vector<char> were_seen(count);
  if (head.has_seen) {
    file_->Read(head.offset + block.nodes * sizeof(SpooledMotion) + first,
                were_seen.data(), count);
  }
  const std::vector<char> needed = Needed();
  std::vector<int> place(nodes_ever_, -1);
  std::vector<NodeMotion> motions;
  std::vector<char> seen;
  const auto add = [&](int number, const NodeMotion& motion, char was_seen) {
    if (needed[number] == 0) return;
    place[number] = static_cast<int>(motions.size());
    motions.push_back(motion);
    seen.push_back(was_seen);
  };
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const std::size_t at = places.empty() ? k : places[k] - first;
    add(numbers[k], MotionFrom(&bytes[at * sizeof(SpooledMotion)]),
        were_seen[at]);
  }
  for (const Births& births : births_) {
    const bool known = births.numbers->front() < block.nodes_ever;
    if (known && head.index >= births.frame) continue;
    std::vector<NodeMotion> of_carriers;
    for (const int carrier : births.nodes->carriers()) {
      of_carriers.push_back(motions[place[carrier]]);
    }
    const std::vector<NodeMotion> blended = births.nodes->Blended(of_carriers);
    for (std::size_t i = 0; i < blended.size(); ++i) {
      add((*births.numbers)[i], blended[i], false);
    }
  }
  FrameMotions frame{head.index, head.tracked, {}, {}};
  for (const int number : *numbers_) {
    frame.motions.push_back(motions[place[number]]);
  }
  // As of frames in memory: of those that grew it is known of every node.
  if (head.has_seen || block.changes != changes_) {
    for (const int number : *numbers_) {
      frame.seen.push_back(seen[place[number]]);
    }
  }
  return frame;
}

std::optional<FrameMotions> MotionLog::Find(int frame) const {
  int begin = 0;
  for (int end = size(); begin < end;) {
    const int middle = begin + (end - begin) / 2;
    if (this->frame(middle) < frame) {
      begin = middle + 1;
    } else {
      end = middle;
    }
  }
  if (begin == size() || this->frame(begin) != frame) return std::nullopt;
  return At(begin);
}

MotionHistory MotionLog::All() const {
  MotionHistory history;
  for (int i = 0; i < size(); ++i) history.Append(At(i));
  return history;
}

void MotionLog::Append(FrameMotions frame) {
  const auto nodes = static_cast<int>(frame.motions.size());
  if (numbers_ == nullptr) {
    numbers_ = NumbersFrom(0, nodes);
    nodes_ever_ = nodes;
  }
  assert(frame.motions.size() == numbers_->size());
  recent_bytes_ += frame.bytes();
  recent_.push_back(std::move(frame));
  while (recent_bytes_ > memory_ && recent_.size() > kBlockFrames) Spool();
}

void MotionLog::Grow(const NodeBirths& births, const NodeChange& change) {
  if (empty()) return;
  recent_bytes_ = 0;
  for (FrameMotions& frame : recent_) {
    births.Append(&frame.motions);
    frame.seen.resize(frame.motions.size(), false);
    change.Apply(&frame.motions);
    change.Apply(&frame.seen);
    recent_bytes_ += frame.bytes();
  }
  const auto born = NumbersFrom(nodes_ever_, nodes_ever_ + births.size());
  std::vector<int> numbers = *numbers_;
  numbers.insert(numbers.end(), born->begin(), born->end());
  if (!born->empty()) {
    births_.push_back({born, std::make_shared<const NodeBirths>(
                                 births.Renumbered(*numbers_))});
  }
  change.Apply(&numbers);
  numbers_ = std::make_shared<const std::vector<int>>(std::move(numbers));
  nodes_ever_ += births.size();
  ++changes_;
}

/// What no node that there is now was blended from will not be needed again.
void MotionLog::ForgetNeedlessBirths() {
  std::vector<char> needed(nodes_ever_, false);
  for (const int number : *numbers_) needed[number] = true;
  std::vector<Births> kept;
  for (auto births = births_.rbegin(); births != births_.rend(); ++births) {
    const std::vector<int>& numbers = *births->numbers;
    // All frames in the file have motions of what was born before them.
    if (blocks_.empty() || numbers.front() < blocks_.front()->nodes_ever) break;
    std::vector<char> chosen;
    for (const int number : numbers) chosen.push_back(needed[number]);
    const auto count = std::count(chosen.begin(), chosen.end(), true);
    if (count == 0) continue;
    if (count < static_cast<std::ptrdiff_t>(numbers.size())) {
      births->nodes =
          std::make_shared<const NodeBirths>(births->nodes->Part(chosen));
      births->numbers =
          std::make_shared<const std::vector<int>>(Chosen(numbers, chosen));
    }
    for (const int carrier : births->nodes->carriers()) needed[carrier] = true;
    kept.push_back(std::move(*births));
  }
  std::reverse(kept.begin(), kept.end());
  births_ = std::move(kept);
}

/// Moves the first frames that lie in memory to the file.
void MotionLog::Spool() {
  Block block;
  block.numbers = numbers_;
  block.nodes = static_cast<int>(numbers_->size());
  block.nodes_ever = nodes_ever_;
  block.changes = changes_;
  while (!recent_.empty() && block.frames.size() < kBlockFrames) {
    const FrameMotions& frame = recent_.front();
    const std::vector<char> bytes = BytesOfFrame(frame);
    block.frames.push_back({frame.frame, frame.tracked, !frame.seen.empty(),
                            file_->Append(bytes.data(), bytes.size())});
    recent_bytes_ -= frame.bytes();
    recent_.pop_front();
  }
  spooled_ += static_cast<int>(block.frames.size());
  blocks_.push_back(std::make_shared<const Block>(std::move(block)));
  block_ends_.push_back(spooled_);
  ForgetNeedlessBirths();
}

void MotionLog::Replace(int i, const std::vector<NodeMotion>& motions) {
  if (i >= spooled_) {
    recent_[i - spooled_].motions = motions;
    return;
  }
  assert(changes_ == 0 && motions.size() == numbers_->size());
  const std::vector<char> bytes = BytesOfFrame({0, true, motions, {}});
  file_->Write(HeadOf(i).offset, bytes.data(), bytes.size());
}

MotionLog MotionLog::Part(const std::vector<char>& nodes,
                          const DeformationGraph& graph) const {
  MotionLog part(file_, memory_);
  if (numbers_ == nullptr || graph.size() == 0) return part;
  const int first_frame = graph.first_seen.front();
  const std::vector<int> numbers = Chosen(*numbers_, nodes);
  for (const std::shared_ptr<const Block>& block : blocks_) {
    if (block->frames.back().index < first_frame) continue;
    part.blocks_.push_back(
        std::make_shared<const Block>(block->Part(numbers, first_frame)));
    part.spooled_ += static_cast<int>(part.blocks_.back()->frames.size());
    part.block_ends_.push_back(part.spooled_);
  }
  for (const FrameMotions& frame : recent_) {
    if (frame.frame < first_frame) continue;
    part.recent_.push_back({frame.frame, frame.tracked,
                            Chosen(frame.motions, nodes),
                            Chosen(frame.seen, nodes)});
    part.recent_bytes_ += part.recent_.back().bytes();
  }
  part.nodes_ever_ = graph.size();
  part.numbers_ = NumbersFrom(0, part.nodes_ever_);
  part.changes_ = changes_;
  part.Finish();
  part.births_ = BirthsIn(graph);  // Needed for frames that know them, too.
  return part;
}

void MotionLog::Finish() {
  while (!recent_.empty()) Spool();
}

namespace {

/// Saves or restores a value that is shared and does not change.
template <typename Archive, typename T>
void SerializeShared(Archive* archive, std::shared_ptr<const T>* shared) {
  T value;
  if constexpr (!Archive::kReads) value = **shared;
  (*archive)(value);
  if constexpr (Archive::kReads) {
    *shared = std::make_shared<const T>(std::move(value));
  }
}

}  // namespace

template <typename Archive>
void MotionLog::SerializeIndex(Archive* archive) {
  assert(recent_.empty());
  blocks_.resize(archive->Count(blocks_.size(), 1));
  for (std::shared_ptr<const Block>& shared : blocks_) {
    Block block;
    if constexpr (!Archive::kReads) block = *shared;
    (*archive)(block.frames, block.places, block.nodes, block.nodes_ever,
               block.changes);
    SerializeShared(archive, &block.numbers);
    if constexpr (Archive::kReads) {
      shared = std::make_shared<const Block>(std::move(block));
    }
  }
  (*archive)(block_ends_, spooled_, nodes_ever_, changes_);
  if (spooled_ == 0) return;  // It has no nodes.
  SerializeShared(archive, &numbers_);
  births_.resize(archive->Count(births_.size(), 1));
  for (Births& births : births_) {
    SerializeShared(archive, &births.numbers);
    SerializeShared(archive, &births.nodes);
    (*archive)(births.frame);
  }
}

template void MotionLog::SerializeIndex(ArchiveWriter*);
template void MotionLog::SerializeIndex(ArchiveReader*);

}  // namespace splitfusion
