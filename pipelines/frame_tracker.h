#ifndef SPLITFUSION_PIPELINES_FRAME_TRACKER_H_
#define SPLITFUSION_PIPELINES_FRAME_TRACKER_H_

#include <map>
#include <optional>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/energy/surface_energies.h"
#include "splitfusion/lib/energy/term_context.h"
#include "splitfusion/lib/energy/term_state.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/model/surface.h"
#include "splitfusion/lib/render/model_map.h"
#include "splitfusion/lib/render/model_rendering.h"
#include "splitfusion/lib/report/frame_report.h"
#include "splitfusion/lib/tracking/frame_matcher.h"
#include "splitfusion/lib/tracking/key_frames.h"
#include "splitfusion/lib/tracking/last_sights.h"
#include "splitfusion/lib/tracking/point_motion.h"
#include "splitfusion/lib/tracking/point_tracks.h"
#include "splitfusion/pipelines/pipeline_options.h"
#include "splitfusion/pipelines/registries.h"
#include "splitfusion/pipelines/surface_tracker.h"

namespace splitfusion {

/// What surfaces are compared with in one frame; refers to all but the last.
struct FrameScene {
  const FrameFacts& frame;         ///< Index, time stamp and detections.
  const LiveView& live;            ///< Images, with labels.
  const SurfaceMap& surfaces;      ///< All surfaces, by id.
  const MeshRendering& rendering;  ///< Models that are drawn from meshes.
  const ModelMap& background;      ///< Ray cast of the background, or empty.
  /// The camera's frame from that of the frame before, metres, as far as the
  /// background has been tracked.
  Rigid3d camera_from_previous_camera = Rigid3d::Identity();
};

/// Tracks surfaces from frame to frame. Between frames it keeps points that are
/// followed from image to image, the last image, in which points are matched,
/// and what terms keep. In every frame: Begin(), Track() for some surfaces,
/// Keep().
class FrameTracker {
 public:
  /// `registries`: what the options may name; not kept.
  ///
  /// @throw InputError if an option of tracker or solver is out of its range,
  ///     or names something else; as FrameMatcher does.
  FrameTracker(const PipelineOptions& options, const Registries& registries);

  /// Looks at the live frame, whose labels are known, and follows points of all
  /// surfaces, but of a background that is ray cast, into it. Only these
  /// surfaces may be tracked in it.
  void Begin(const SurfaceMap& surfaces, const LiveView& live);

  /// Moves a surface onto its live pixels from where it is predicted, and
  /// returns whether it fits; else `report` says why not. `samples`: what is in
  /// view of it; `still` as of SurfaceTracker::Track(), a rigid motion of the
  /// camera frame, metres; `goes_on` as of SurfaceContext: then its parts may
  /// start elsewhere (PartStarter). Different surfaces may be tracked at the
  /// same time.
  ///
  /// @throw InputError or std::runtime_error if a term throws, see
  ///     TermStates::Prepare().
  bool Track(const std::vector<ModelSample>& samples, const Rigid3d& still,
             bool goes_on, const FrameScene& scene, Surface* surface,
             SurfaceReport* report);

  /// Where the terms' own unknowns of a surface begin from now on: where the
  /// tracking ended that counts. Of several in a frame only that.
  void KeepUnknowns(const Surface& surface, const SurfaceReport& report);

  /// A surface that was tracked is in plain view, so that it will be known
  /// again by how it looks now.
  void KeepSight(const Surface& surface, const LiveView& live);
  /// As LastSights::FindMotion() of a surface where it is predicted.
  std::optional<Rigid3d> MotionSinceSight(const Surface& surface,
                                          const LiveView& live) const;

  /// The background was tracked: here the camera's path leads, see
  /// KeyFrames::KeepOnPath(); before KeepCamera().
  void KeepOnPath(const Surface& background, const LiveView& live, int frame,
                  bool goes_on) {
    key_frames_.KeepOnPath(live, MeanRigidMotion(background.graph()), frame,
                           goes_on);
  }
  /// As KeyFrames::Path().
  std::vector<PathFrame> CameraPath(const PinholeCamera& camera) const {
    return key_frames_.Path(camera);
  }
  /// The background was tracked: a camera that is lost will be looked for here.
  void KeepCamera(const Surface& background, const LiveView& live) {
    key_frames_.Keep(live, MeanRigidMotion(background.graph()));
  }
  /// As KeyFrames::Find().
  std::vector<Rigid3d> CameraPlaces(const LiveView& live) const {
    return key_frames_.Find(live);
  }
  /// Ends a frame: keeps what the next one is compared with.
  void Keep(const LiveView& live);

  /// Forgets a surface, whose model is another one from now on.
  void Forget(int id);
  /// Forgets what is kept of a surface that is there no more; its points end
  /// with the next Begin().
  void ForgetGone(int id);

  /// Points of the surfaces; to be put back where tracking is to be undone.
  const PointTracks& point_tracks() const { return point_tracks_; }
  /// Puts them back.
  void set_point_tracks(const PointTracks& tracks) { point_tracks_ = tracks; }

  /// What is minimised.
  const SurfaceEnergies& energies() const { return tracker_.energies(); }

  /// Saves or restores it between two frames, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(point_tracks_, matcher_, sights_, key_frames_, term_states_);
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
  LastSights sights_;
  KeyFrames key_frames_;
  double match_ratio_;
  SurfaceTracker tracker_;
  /// What the terms of a surface keep of it.
  std::map<int, TermStates> term_states_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_FRAME_TRACKER_H_
