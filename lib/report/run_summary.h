#ifndef SPLITFUSION_LIB_REPORT_RUN_SUMMARY_H_
#define SPLITFUSION_LIB_REPORT_RUN_SUMMARY_H_

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/stretched_area.h"
#include "splitfusion/lib/report/frame_parts.h"
#include "splitfusion/lib/report/frame_report.h"
#include "splitfusion/lib/report/loop_report.h"

namespace splitfusion {

/// What was written of a surface at the end.
struct WrittenSurface {
  int nodes = 0;          ///< Of the graph.
  int vertices = 0;       ///< Of the mesh.
  StretchedArea stretch;  ///< Of all warped meshes, see WriteSurface().
};

/// One surface over a whole run.
struct SurfaceSummary {
  int id = 0;                              ///< 0 is the background.
  std::string label;                       ///< Class name; spaces kept.
  SurfaceKind kind = SurfaceKind::kRigid;  ///< Of its last report.
  int first_frame = 0;                     ///< Frame of its birth.
  int frames = 0;             ///< Frames in which it was born or tracked.
  int nodes = 0;              ///< Of the final graph.
  double node_spacing = 0;    ///< Of the final graph, metres; 0 if rigid.
  int vertices = 0;           ///< Of the final mesh.
  std::vector<int> lost;      ///< Frames whose solve failed.
  std::vector<int> occluded;  ///< Frames in which others mostly hid it.
  /// Frames in which it was tracked again after it had been lost, occluded or
  /// out of view.
  std::vector<int> refound;
  std::vector<int> reanchored;  ///< Frames in which its model began anew.
  /// Frames in which the camera was found by landmarks.
  std::vector<int> relocalized;
  /// The frame in which it was lost or occluded and after which it was not
  /// tracked again to the end of the run; -1 = it was.
  int away_since = -1;
  /// Share of the area of the warped meshes that was stretched, and cut;
  /// none where no warped mesh was written.
  std::optional<double> stretched;
  /// Of the last frame that tells.
  std::optional<HoldReport> hold;

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(id, label, kind, first_frame, frames, nodes, node_spacing,
               vertices, lost, occluded, refound, reanchored, relocalized,
               away_since, hold);
  }
};

/// What `summary.json` holds.
struct RunSummary {
  bool complete = true;  ///< False if the run ended before the sequence did.
  std::string status = "complete";  ///< ToString(RunStatus).
  std::string error;                ///< Of a failed run, one line.
  std::vector<int> resumed_at;      ///< Frames from which the run went on.
  std::vector<int> skipped_frames;  ///< Left out: images not usable.
  LoopReport loops;                 ///< Without key frames: not looked for.
  std::string preset;               ///< Name of the preset.
  std::map<std::string, std::string> versions;  ///< Library -> version.
  int frames = 0;                               ///< Frames processed.
  int lost_frames = 0;        ///< Frames in which any surface was lost.
  int occluded_frames = 0;    ///< Frames in which any surface was occluded.
  int refound_frames = 0;     ///< Frames in which any surface was found again.
  double median_seconds = 0;  ///< Per frame, without writing.
  double mean_seconds = 0;    ///< Per frame, without writing.
  /// Mean seconds per frame of each part, in the order of kFrameParts.
  std::array<double, kFrameParts.size()> part_seconds{};
  double seconds_writing = 0;   ///< Of the whole run.
  double seconds_refining = 0;  ///< At the end of the run.
  double seconds_coloring = 0;  ///< At the end of the run.
  /// By the clock, of everything, from the start of the run to its summary.
  double all_seconds_per_frame = 0;
  double cpu_seconds_per_frame = 0;      ///< Of all threads, mean.
  std::int64_t peak_memory_bytes = 0;    ///< Largest resident size.
  std::vector<SurfaceSummary> surfaces;  ///< By id.
};

/// One line that says whether everything was followed: frames, surfaces, and
/// those that were lost, occluded and found again or not.
std::string VerdictLine(const RunSummary& summary);

/// A line of every surface parts of which no data held in the last frame that
/// tells: "17 of 310 nodes of surface 1 (person) are held by the prior alone".
/// Empty without covariances.
std::vector<std::string> HoldLines(const RunSummary& summary);

/// Text of `summary.json` as a value; keys in docs/report_format.md.
nlohmann::ordered_json ToJson(const RunSummary& summary);

/// Gathers the statistics of a run from its frames.
class SummaryBuilder {
 public:
  /// Adds the next frame.
  void Add(const FrameReport& report);

  /// Takes what was written of a surface at the end for what was reported.
  /// Unknown ids are ignored.
  void SetWritten(int id, const WrittenSurface& written);

  /// Statistics of the frames so far; preset, versions, writing time and memory
  /// are left to the caller.
  RunSummary Build() const;

  /// Saves or restores the statistics so far, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    archive->Section("summary");
    (*archive)(lost_frames_, occluded_frames_, refound_frames_, last_states_,
               seconds_, part_sums_, surfaces_);
  }

 private:
  /// Returns whether the surface was found again.
  bool AddSurface(int frame, const SurfaceReport& report);

  int lost_frames_ = 0;
  int occluded_frames_ = 0;
  int refound_frames_ = 0;
  std::map<int, TrackState> last_states_;  // By surface.
  std::vector<double> seconds_;
  std::array<double, kFrameParts.size()> part_sums_{};
  std::map<int, SurfaceSummary> surfaces_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_RUN_SUMMARY_H_
