#include "splitfusion/lib/split/tentative_tracks.h"

#include <algorithm>

namespace splitfusion {
int TentativeTracks::Record(int index, int frame, const cv::Mat_<uchar>& mask,
                            const Appearance& appearance, bool counts) {
  if (index < 0) {
    index = static_cast<int>(tracks_.size());
    tracks_.emplace_back();
  }
  TentativeTrack& track = tracks_.at(index);
  track.mask = mask.clone();
  track.appearance = appearance;
  track.frame = frame;
  track.evidence = counts ? track.evidence + 1 : track.evidence - 0.5;
  return index;
}

void TentativeTracks::EndFrame(int frame) {
  for (TentativeTrack& track : tracks_) {
    if (track.frame < frame) track.evidence -= 0.5;
  }
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(),
                               [](const TentativeTrack& track) {
                                 return track.evidence <= 0;
                               }),
                tracks_.end());
}

}  // namespace splitfusion
