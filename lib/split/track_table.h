#ifndef SPLITFUSION_LIB_SPLIT_TRACK_TABLE_H_
#define SPLITFUSION_LIB_SPLIT_TRACK_TABLE_H_

#include <map>
#include <set>
#include <string>

#include "splitfusion/lib/segmentation/label_table.h"
#include "splitfusion/lib/split/appearance.h"
#include "splitfusion/lib/tracking/track_state.h"

namespace splitfusion {

/// A surface that is followed over time.
struct Track {
  int id = 0;              ///< From 1, in order of birth, never reused.
  std::string class_name;  ///< Majority of its detections, by score.
  SurfaceKind kind = SurfaceKind::kNonRigid;  ///< Of its class at birth.
  int first_frame = 0;                        ///< Frame of its birth.
  int last_detected_frame = 0;  ///< Latest frame with a detection of it.
  TrackState state = TrackState::kTentative;  ///< Changed by Apply() alone.
  Appearance appearance;                ///< Of the frames it was detected.
  int lost_frames = 0;                  ///< kMisfits since tracked or inactive.
  double usual_pixels = 0;              ///< Running mean while it is tracked.
  std::map<std::string, double> votes;  ///< Sum of scores by class.
  int merged_into = 0;  ///< Surface that it turned out to be; 0 = none.

  /// Takes in an event.
  void Apply(TrackEvent event);

  /// Takes in a detection: class vote, last frame; an inactive surface is
  /// looked for again.
  void Detect(int frame, const std::string& detected_class, double score);

  /// Whether it should be somewhere in the scene.
  bool followed() const { return state != TrackState::kInactive; }

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(id, class_name, kind, first_frame, last_detected_frame, state,
               appearance, lost_frames, usual_pixels, votes, merged_into);
  }
};

/// Every surface ever born, by id; without the background.
using TrackTable = std::map<int, Track>;

/// Adds a surface and returns its id.
int AddTrack(int frame, const std::string& class_name, SurfaceKind kind,
             TrackTable* tracks);

/// Ids of those that are not inactive.
std::set<int> Followed(const TrackTable& tracks);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_TRACK_TABLE_H_
