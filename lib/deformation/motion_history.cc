#include "splitfusion/lib/deformation/motion_history.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <utility>

#include "splitfusion/lib/base/spooled_list.h"

namespace splitfusion {

int FrameMotions::IndexOf(int node) const {
  if (ranges.empty()) {
    return node < static_cast<int>(motions.size()) ? node : -1;
  }
  int before = 0;
  for (const NodeRange& range : ranges) {
    if (node < range.begin) return -1;
    if (node < range.end) return before + node - range.begin;
    before += range.end - range.begin;
  }
  return -1;
}

std::size_t FrameMotions::bytes() const {
  return sizeof(*this) + motions.size() * sizeof(NodeMotion) + seen.size() +
         ranges.size() * sizeof(NodeRange);
}

void FrameMotions::SpreadTo(std::vector<NodeMotion>* all) const {
  auto from = motions.begin();
  const std::vector<NodeRange> of_all = {{0, static_cast<int>(motions.size())}};
  for (const NodeRange& range : ranges.empty() ? of_all : ranges) {
    const auto count = range.end - range.begin;
    std::copy_n(from, count, all->begin() + range.begin);
    from += count;
  }
}

MotionHistory::MotionHistory(std::size_t memory)
    : memory_(memory),
      spooled_(std::make_shared<SpooledList<FrameMotions>>()) {}

/// That of a frame; -1: there is none.
int MotionHistory::IndexOf(int frame) const {
  const auto found = std::lower_bound(
      places_.begin(), places_.end(), frame,
      [](const Place& place, int index) { return place.frame < index; });
  return found != places_.end() && found->frame == frame
             ? static_cast<int>(found - places_.begin())
             : -1;
}

FrameMotions MotionHistory::At(int i) const {
  const Place& place = places_[i];
  return place.memory != nullptr ? *place.memory : spooled_->At(place.spooled);
}

std::optional<FrameMotions> MotionHistory::Find(int frame) const {
  const int i = IndexOf(frame);
  if (i < 0) return std::nullopt;
  return At(i);
}

void MotionHistory::Append(FrameMotions frame) {
  assert(places_.empty() || places_.back().frame < frame.frame);
  Place place;
  Put(std::move(frame), &place);
  places_.push_back(std::move(place));
}

void MotionHistory::Replace(FrameMotions frame) {
  assert(Has(frame.frame));
  Place& place = places_[IndexOf(frame.frame)];
  if (place.memory != nullptr) used_ -= place.memory->bytes();
  Put(std::move(frame), &place);
}

/// Copies of this share the list: what lies there stays as it is.
void MotionHistory::Put(FrameMotions frame, Place* place) {
  place->frame = frame.frame;
  place->tracked = frame.tracked;
  if (used_ + frame.bytes() > memory_) {
    place->memory = nullptr;
    place->spooled = spooled_->size();
    spooled_->Add(frame);
    return;
  }
  used_ += frame.bytes();
  place->memory = std::make_shared<const FrameMotions>(std::move(frame));
}

PartEnds EndsOfParts(const MotionHistory& history,
                     const DeformationGraph& graph) {
  PartEnds ends;
  if (graph.parts.empty()) return ends;
  ends.first.resize(graph.size());
  ends.last.resize(graph.size());
  // Frames are read once.
  std::multimap<int, std::pair<std::size_t, std::vector<NodeMotion>*>> asked;
  for (std::size_t k = 0; k < graph.parts.size(); ++k) {
    asked.insert({graph.parts[k].first_frame, {k, &ends.first}});
    asked.insert({graph.parts[k].end_frame - 1, {k, &ends.last}});
  }
  std::optional<FrameMotions> frame;
  for (const auto& [index, of] : asked) {
    if (!frame || frame->frame != index) frame = history.Find(index);
    const auto& [k, motions] = of;
    const int node = graph.parts[k].node;
    const int from = frame ? frame->IndexOf(node) : -1;
    if (from < 0) continue;
    std::copy_n(frame->motions.begin() + from, graph.EndOfPart(k) - node,
                motions->begin() + node);
  }
  return ends;
}

std::vector<NodeMotion> MotionsOfAll(const MotionHistory& history,
                                     const DeformationGraph& graph,
                                     const PartEnds& ends, int frame) {
  std::vector<NodeMotion> all(graph.size());
  for (std::size_t k = 0; k < graph.parts.size(); ++k) {
    const ModelPart& part = graph.parts[k];
    const std::vector<NodeMotion>& nearest =
        frame < part.first_frame ? ends.first : ends.last;
    std::copy(nearest.begin() + part.node, nearest.begin() + graph.EndOfPart(k),
              all.begin() + part.node);
  }
  history.Find(frame)->SpreadTo(&all);
  return all;
}

}  // namespace splitfusion
