#ifndef SPLITFUSION_PIPELINES_SPLIT_FUSION_H_
#define SPLITFUSION_PIPELINES_SPLIT_FUSION_H_

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "splitfusion/lib/energy/surface_energies.h"
#include "splitfusion/lib/energy/term_context.h"
#include "splitfusion/lib/model/surface.h"
#include "splitfusion/lib/render/model_rendering.h"
#include "splitfusion/lib/report/frame_report.h"
#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/sequence/trajectory.h"
#include "splitfusion/lib/split/surface_splitter.h"
#include "splitfusion/lib/tracking/motion_predictor.h"
#include "splitfusion/lib/tracking/usual_misfit.h"
#include "splitfusion/pipelines/loop_closure.h"
#include "splitfusion/pipelines/pipeline_options.h"
#include "splitfusion/pipelines/prepared_frame.h"
#include "splitfusion/pipelines/registries.h"
#include "splitfusion/pipelines/standing_objects.h"

namespace splitfusion {

class FrameTracker;
struct FrameScene;

/// SplitFusion: simultaneous tracking and mapping of rigid and non-rigid
/// surfaces. Feed frames in order; read surfaces and trajectory at any time.
class SplitFusion {
 public:
  /// `segmenter` may be null: then nothing is split off. `registries`: what the
  /// options may name; not kept.
  /// @throw InputError if an option is out of its range or names something
  ///     else.
  SplitFusion(const PinholeCamera& camera, const PipelineOptions& options,
              const LabelTable& labels, std::shared_ptr<Segmenter> segmenter,
              const Registries& registries = {});
  ~SplitFusion();  ///< Where FrameTracker is known.

  /// One frame of the paper's overview figure: split, track every surface,
  /// fuse every surface.
  FrameReport ProcessFrame(const Frame& frame) {
    return ProcessFrame(Prepare(frame));
  }

  /// The first part of ProcessFrame(), which needs no model: it may run on
  /// another thread while the frame before is processed. Frames in order, one
  /// at a time.
  PreparedFrame Prepare(const Frame& frame) const {
    return PrepareFrame(camera_, frame, options_.point_map, segmenter(),
                        color_camera_);
  }
  /// The same without detections, for a pass over frames that are done.
  PreparedFrame PrepareUnsplit(const Frame& frame) const;
  /// The rest of it.
  FrameReport ProcessFrame(PreparedFrame prepared);

  /// Once all frames are known: the poses of those in which the camera was
  /// tracked, without drift; none of a background that deforms, or without
  /// PipelineOptions::close_loops.
  LoopClosure CloseCameraLoops() const;

  /// How well the camera's view usually fits, as found in a first pass over the
  /// same frames: given poses do not tell. Before the first frame.
  void set_camera_misfit(const UsualMisfit& misfit) { camera_misfit_ = misfit; }
  /// The same so far.
  const UsualMisfit& camera_misfit() const { return camera_misfit_; }

  /// Once all frames are known: the poses of frames in which the camera was
  /// lost go smoothly from the last known one to the next, see PoseAmid().
  void PlaceLostCamera();

  /// Extracts the final meshes of all surfaces.
  void Finish();

  /// All surfaces by id, the background first.
  const SurfaceMap& surfaces() const { return surfaces_; }
  /// Camera poses so far; the world is the first camera.
  const Trajectory& trajectory() const { return trajectory_; }
  /// The same by frame index, since there is a background: world from camera.
  std::map<int, Rigid3d> PosesByFrame() const;
  /// Intrinsics.
  const PinholeCamera& camera() const { return camera_; }
  /// The colour images of all frames are from this camera, not registered to
  /// the depth images; before the first frame.
  void set_color_camera(const std::optional<ColorCamera>& color_camera) {
    color_camera_ = color_camera;
  }
  /// Of colour images that are not registered.
  const std::optional<ColorCamera>& color_camera() const {
    return color_camera_;
  }
  /// Rows of all images were exposed one after the other, the last one so many
  /// seconds after the first; 0: all at once. Before the first frame.
  void set_rolling_shutter(double seconds) { rolling_shutter_ = seconds; }
  /// That time, seconds.
  double rolling_shutter() const { return rolling_shutter_; }
  /// Null if nothing is split off.
  Segmenter* segmenter() const {
    return options_.split_scene ? segmenter_.get() : nullptr;
  }
  /// Options in use.
  const PipelineOptions& options() const { return options_; }
  /// What is minimised.
  const SurfaceEnergies& energies() const;
  /// Surface ids of the last frame, HxW.
  const LabelImage& labels() const { return live_.labels; }

  /// Version of what Serialize() writes: another one with every change of it.
  static constexpr std::uint32_t kStateVersion = 26;  // Format.

  /// Saves or restores everything that later frames and results depend on, see
  /// lib/base/archive.h: one made with the same arguments goes on as this one
  /// would have done, byte for byte. Between two frames, before Finish();
  /// Prepare() may run meanwhile. A SplitFusion whose restoring failed is of no
  /// use any more.
  ///
  /// @throw InputError if what is read does not fit camera or voxels.
  template <typename Archive>
  void Serialize(Archive* archive);

 private:
  /// `given`: known pose of the camera, see Frame.
  Rigid3d CameraMotion(const std::optional<Rigid3d>& given) const;
  void Unroll(const Rigid3d& camera_motion, double seconds,
              PreparedFrame* prepared) const;
  double SecondsSince(const Frame& frame) const;
  void UnrollAsTracked(const PreparedFrame& rolled,
                       const std::vector<ModelSample>& samples,
                       FrameReport* report);
  void PredictMotions(const Rigid3d& camera_motion);
  void Split(const PreparedFrame& prepared, FrameReport* report);
  /// What surfaces are tracked in.
  FrameScene Scene() const;
  /// As FrameTracker::Track().
  bool TrackSurface(const std::vector<ModelSample>& samples,
                    const Rigid3d& still, bool goes_on, Surface* surface,
                    SurfaceReport* report);
  /// What is in view of the background, where it is predicted.
  std::vector<ModelSample> BackgroundInView(FrameReport* report) const;
  /// Moves the background, which comes in at the predicted motion, as
  /// TrackSurface() does, and all other surfaces with it.
  void TrackBackground(const std::vector<ModelSample>& samples,
                       const Rigid3d& still, bool goes_on, FrameReport* report);
  /// A camera motion moves every surface.
  void MoveObjects(const Rigid3d& camera_motion);
  /// Where the background was tracked to, and how well it fits there.
  struct CameraFit {
    Rigid3d camera_from_world = Rigid3d::Identity();
    TrackState state = TrackState::kLost;
    SurfaceReport report;
    double misfit = std::numeric_limits<double>::infinity();  ///< If tracked.
  };
  CameraFit FitOfCamera(const FrameReport& report) const;
  /// Whether the background was tracked, and fits about as well as before.
  bool FitsAsUsual(const FrameReport& report) const;
  /// Whether tracking came to an end that fits as usual.
  bool IsCameraFound(const FrameReport& report) const;
  /// Tracks the background from where its landmarks say that the camera is; the
  /// place that fits best counts. A camera that neither fits as usual nor is
  /// known by landmarks is lost, and is where it was predicted. `samples`: what
  /// is in view.
  void FindCamera(const Rigid3d& predicted, std::vector<ModelSample>* samples,
                  FrameReport* report);
  /// Places the camera, and all surfaces with it.
  void MoveCamera(const Rigid3d& camera_from_world);
  /// Sets standing objects apart that move on their own, as the camera sees
  /// it that is tracked without any of them: the background forgets them, and
  /// their pixels are no part of it. Whether there are any.
  bool SetMoversApart(const std::vector<ModelSample>& samples,
                      FrameReport* report);
  /// The pose of the camera, `given` or tracked, apart from such objects.
  void TrackCamera(const PreparedFrame& rolled, FrameReport* report);
  /// Every object on its own and at the same time.
  void TrackObjects(FrameReport* report);
  /// Ends the tracks of surfaces that nothing hides and that are not there all
  /// the same, so that they hide nothing; whether there are any.
  bool EndGoneTracks();
  TrackState StateOf(int id) const;
  /// Motions of the camera frame that may take a surface to where its live
  /// pixels are, the likeliest first: what it looked like tells, or what shape
  /// it has; else it may be where it is predicted.
  std::vector<Rigid3d> WaysToWhereSeen(const Surface& surface,
                                       SurfaceReport* report) const;
  /// `goes_on`: as of SurfaceContext.
  bool TrackObject(bool goes_on, Surface* surface, SurfaceReport* report);
  /// Tracks a surface that is lost or was occluded from where its live pixels
  /// are; leaves it where it was if that fails.
  bool TrackWhereSeen(Surface* surface, SurfaceReport* report);
  /// Whether enough model points of what was just tracked lie on it, for the
  /// live pixels that are certain; else the report says why not.
  bool ExplainsItsPixels(SurfaceReport* report) const;
  void Fuse(FrameReport* report);
  /// Tells surfaces what became of their tracks.
  void FollowTracks();
  /// What objects in plain view look like, and what the camera saw. `given`: it
  /// was not tracked.
  void KeepSights(bool given, const FrameReport& report);
  /// Whether the live pixels of a surface show about as much of it as usual.
  bool InPlainView(const SurfaceReport& report) const;
  void ReanchorLostSurfaces(FrameReport* report);
  void AddNewSurfaces(const Frame& frame, FrameReport* report);
  void Record(const Frame& frame, FrameReport* report);
  template <typename Archive>
  void SerializeSurfaces(Archive* archive);
  const SurfaceOptions& OptionsOf(int id) const {
    return id == 0 ? options_.background : options_.object;
  }
  Rigid3d WorldFromCamera() const;

  PinholeCamera camera_;
  std::optional<ColorCamera> color_camera_;
  double rolling_shutter_ = 0;
  PipelineOptions options_;
  std::shared_ptr<Segmenter> segmenter_;
  SurfaceSplitter splitter_;
  std::unique_ptr<FrameTracker> tracker_;
  SurfaceMap surfaces_;
  Trajectory trajectory_;
  FrameFacts frame_;  ///< That in hand.
  LiveView live_;
  StandingObjects standing_;
  std::vector<StandingObject> detected_standing_;  ///< In the frame in hand.
  MeshRendering rendering_;
  ModelMap background_map_;
  /// By surface; of the background in the camera frame, of others in world.
  std::map<int, MotionPredictor> predictors_;
  /// World, the first camera, from that of given poses.
  Rigid3d world_from_given_ = Rigid3d::Identity();
  TrackState background_state_ = TrackState::kTracked;  ///< Of this frame.
  bool camera_was_lost_ = false;  ///< In the frame before.
  UsualMisfit camera_misfit_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_SPLIT_FUSION_H_
