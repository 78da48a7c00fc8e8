#ifndef SPLITFUSION_LIB_EVALUATION_PRESENCE_H_
#define SPLITFUSION_LIB_EVALUATION_PRESENCE_H_

#include <map>
#include <vector>

namespace splitfusion {

/// When an instance is in plain view, and when a surface shows it.
struct PresenceOptions {
  /// More live pixels (of its true label, with depth) than these.
  int plain_view_pixels = 8000;
  /// Part of them at which the surface lies at the live depth.
  double shown_share = 0.6;

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// So many frames after an instance came into view do not count yet: a surface
/// has to be found or made first.
constexpr int kEntryFrames = 3;
/// An instance that is not shown so many frames after it was first in plain
/// view is missing from then on; until then it may still be waited for.
constexpr int kPatienceFrames = 15;

/// What is to be seen of an instance in one frame.
struct InstanceSighting {
  int frame = 0;        ///< Frame index.
  int live_pixels = 0;  ///< Of its true label, with live depth.
  /// Pixels of its true label kEntryFrames before; -1 = there was no such
  /// frame.
  int earlier_pixels = -1;
  /// Surface id -> part of the live pixels that it shows. Those that show
  /// nothing may be left out.
  std::map<int, double> shares;
};

/// In which frames an instance is in plain view, and in which of them it is
/// missing from the model: no surface, or another than its one, shows it.
struct InstancePresence {
  int surface_id = -1;       ///< Its one surface; -1 = no surface shows it.
  std::vector<int> in_view;  ///< Frames that count, ascending.
  std::vector<int> missing;  ///< Those of them in which it is missing.

  /// Whether a frame is one of `in_view`.
  bool InView(int frame) const;
  /// Whether a frame is one of `missing`.
  bool Missing(int frame) const;
  /// `missing` / `in_view`; 0 if it is never in plain view.
  double MissingShare() const;
};

/// Judges an instance over a run. Its one surface is the one that shows most of
/// it, summed over all frames in plain view. Frames before that first shows it
/// do not count, but kPatienceFrames at most, nor do the kEntryFrames after
/// each entry into view.
///
/// `sightings`: of the frames that were looked at, ascending.
InstancePresence JudgePresence(const std::vector<InstanceSighting>& sightings,
                               const PresenceOptions& options = {});

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_PRESENCE_H_
