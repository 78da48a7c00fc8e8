#include "splitfusion/lib/split/track_table.h"

#include <algorithm>

namespace splitfusion {

void Track::Apply(TrackEvent event) {
  state = Next(state, event);
  if (state == TrackState::kLost && event == TrackEvent::kMisfits) {
    ++lost_frames;
  } else if (state == TrackState::kTracked || state == TrackState::kInactive) {
    lost_frames = 0;
  }
}

void Track::Detect(int frame, const std::string& detected_class, double score) {
  Apply(TrackEvent::kDetected);
  last_detected_frame = frame;
  votes[detected_class] += score;
  class_name = std::max_element(votes.begin(), votes.end(),
                                [](const auto& a, const auto& b) {
                                  return a.second < b.second;
                                })
                   ->first;
}

int AddTrack(int frame, const std::string& class_name, SurfaceKind kind,
             TrackTable* tracks) {
  Track track;
  track.id = tracks->empty() ? 1 : tracks->rbegin()->first + 1;
  track.class_name = class_name;
  track.kind = kind;
  track.first_frame = frame;
  track.Apply(TrackEvent::kConfirmed);
  return tracks->emplace(track.id, track).first->first;
}

std::set<int> Followed(const TrackTable& tracks) {
  std::set<int> ids;
  for (const auto& [id, track] : tracks) {
    if (track.followed()) ids.insert(id);
  }
  return ids;
}

}  // namespace splitfusion
