#ifndef SPLITFUSION_PIPELINES_FRAME_TRACKER_H_
#define SPLITFUSION_PIPELINES_FRAME_TRACKER_H_

#include <map>
#include <vector>

#include "splitfusion/lib/energy/term_context.h"
#include "splitfusion/lib/energy/term_state.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/render/model_rendering.h"
#include "splitfusion/lib/report/frame_report.h"
#include "splitfusion/lib/tracking/point_motion.h"
#include "splitfusion/lib/tracking/point_tracks.h"
#include "splitfusion/pipelines/pipeline_options.h"
#include "splitfusion/pipelines/registries.h"
#include "splitfusion/pipelines/surface_tracker.h"

namespace splitfusion {

/// The frame in which a surface is tracked, and the models as they are rendered
/// in it.
struct FrameScene {
  const FrameFacts& frame;         ///< Its facts.
  const LiveView& live;            ///< Its images, with labels.
  const SurfaceMap& surfaces;      ///< Of the scene.
  const MeshRendering& rendering;  ///< Surfaces drawn from their meshes.
  const ModelMap& background;      ///< One that is ray cast; else empty.
  /// The camera's frame from that of the frame before.
  Rigid3d camera_step = Rigid3d::Identity();
};

/// Tracks surfaces frame by frame, with what is kept of them in between: points
/// that are followed from image to image, matches between the two images, and
/// what terms keep.
class FrameTracker {
 public:
  /// `registries`: what the options may name; not kept.
  ///
  /// @throw InputError if an option is out of its range or names something
  ///     else.
  FrameTracker(const PipelineOptions& options, const Registries& registries);

  /// Looks at the live frame, whose labels are known, and follows points of all
  /// surfaces, but of a background that is ray cast, into it.
  void Begin(const SurfaceMap& surfaces, const LiveView& live);

  /// Moves a surface onto its live pixels from where it is predicted; `still`
  /// as of SurfaceTracker::Track(), `goes_on` as of SurfaceContext; only where
  /// it does, parts may start elsewhere (PartStarter). Whether it fits.
  /// Different surfaces may be tracked at the same time.
  bool Track(const std::vector<ModelSample>& samples, const Rigid3d& still,
             bool goes_on, const FrameScene& scene, Surface* surface,
             SurfaceReport* report);

  /// Ends a frame: keeps what the next one is compared with.
  void Keep(const LiveView& live);

  /// Forgets a surface, whose model is another one from now on.
  void Forget(int id);
  /// Forgets a surface that is there no more.
  void Drop(int id) { term_states_.erase(id); }

  /// Points of the surfaces; to be put back where tracking is to be undone.
  const PointTracks& point_tracks() const { return point_tracks_; }
  /// Puts them back.
  void set_point_tracks(const PointTracks& tracks) { point_tracks_ = tracks; }

  /// What is minimised.
  const SurfaceEnergies& energies() const { return tracker_.energies(); }

  /// Saves or restores it between two frames, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(point_tracks_, matcher_, term_states_);
  }

 private:
  bool Follows(const Surface& surface) const {
    return follows_points_ && !surface.is_ray_cast();
  }
  /// Points of a deforming object that were matched with the frame before, as
  /// PartStarter takes them.
  std::vector<PointMotion> MatchPoints(const Surface& surface,
                                       const FrameScene& scene) const;

  bool follows_points_, starts_parts_;
  double non_rigid_distance_;
  PointTracks point_tracks_;
  FrameMatcher matcher_;
  SurfaceTracker tracker_;
  /// What the terms of a surface keep of it; of surfaces that were tracked.
  std::map<int, TermStates> term_states_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_FRAME_TRACKER_H_
