#ifndef SPLITFUSION_PIPELINES_PIPELINE_OPTIONS_H_
#define SPLITFUSION_PIPELINES_PIPELINE_OPTIONS_H_

#include <string>

#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/model/hidden_motions.h"
#include "splitfusion/lib/model/surface.h"
#include "splitfusion/lib/render/ray_caster.h"
#include "splitfusion/lib/split/split_options.h"
#include "splitfusion/lib/tracking/frame_matcher.h"
#include "splitfusion/lib/tracking/key_frames.h"
#include "splitfusion/lib/tracking/point_tracks.h"
#include "splitfusion/pipelines/tracker_options.h"

namespace splitfusion {

/// Options of the whole method. List() names every one; each is a flag of
/// `sf_run` (docs/options.md).
struct PipelineOptions {
  /// Detections to surfaces.
  SplitOptions split;
  /// Model of the background.
  SurfaceOptions background;
  /// Model of every other surface.
  SurfaceOptions object;
  /// Normals of the live frame.
  PointMapOptions point_map;
  /// Warp field of every surface that deforms.
  GraphOptions graph;
  /// Stages, gates and bounds of tracking.
  TrackerOptions tracker;
  /// Points that are followed from image to image.
  PointTrackOptions point_tracks;
  /// Matches between two frames, for where parts start.
  MatchOptions match;
  /// Frames by which a lost camera is found.
  KeyFrameOptions key_frames;
  /// What fits so many times as badly as usual is another scene, or another
  /// place: blur of a fast turn triples the misfit, another scene has twenty
  /// times of it.
  double unusual_misfit = 3;
  /// Minimiser.
  SolverOptions solver;
  /// Motions of what was hidden, once all frames are known.
  HiddenMotionOptions hidden;
  /// Ray casting of the background.
  RayCastOptions ray_cast;
  /// The energy of what deforms, and of what may have come from far away;
  /// syntax of ParseEnergy. Its data term is along the view ray, as the
  /// noise of the depth is.
  static constexpr const char* kDeformingTerms =
      "projective_depth(weight=1,loss=tukey,scale=0.03) "
      "color(weight=8,loss=huber,scale=0.01) "
      "live_to_model(weight=1,loss=huber,scale=0.013) "
      "tracks(weight=16,loss=huber,scale=0.01) arap(weight=8) "
      "temporal_arap(weight=8)";
  /// Eq. 4; syntax of SurfaceEnergies::Parse. Of the background Eq. 5: errors
  /// of a real room's map are not along the ray of today. Its loss, Tukey's,
  /// ends at 4.7 standard deviations of the depth noise (3 mm at its
  /// reference), where it is 95 % as efficient as least squares: what moves and
  /// is no surface yet is left out.
  std::string terms =
      std::string(kDeformingTerms) +
      " background.projective_depth(weight=0) "
      "background.point_to_plane(weight=1,loss=tukey,scale=0.014)";
  int render_stride = 2;       ///< Model maps hold every n-th pixel.
  bool split_scene = true;     ///< False: one surface holds the whole scene.
  bool model_objects = true;   ///< False: moving things are only cut out.
  bool deform_objects = true;  ///< False: moving things are rigid.
  /// Drift of the camera is corrected where it comes back to what it knows, and
  /// everything fused anew if that changes it.
  bool close_loops = true;
  /// Vertices are coloured anew once all frames are known, see
  /// BestViewColors.
  bool best_view_colors = true;
  bool deform_background = false;  ///< True: surface 0 is non-rigid.
  int min_tracked_pixels = 400;    ///< Fewer live pixels: surface is unseen.
  /// A surface of whose model less is in view, of what other surfaces could
  /// hide, is carried on as predicted, neither tracked nor fused; 0 = never.
  double min_exposure = 0.25;
  /// A surface that is looked for where its pixels are is found if as many of
  /// its model points lie on it as this share of those that are certain, at the
  /// same stride: a sliver fits anywhere; 0 = not asked.
  double min_coverage = 0.25;
  /// Whether a surface that is looked for is known by its texture, too.
  bool last_sights = true;
  /// A detection of a rigid class moves if a motion of its own lowers the
  /// squared distance between the mapped background and its depth by so many
  /// variances of the noise, for the mean point; 0 = not looked for.
  double own_motion_gain = 0.5;
  /// Fraction of the image a surface has to cover before it is modelled.
  double min_birth_area = 0.008;
  /// A deforming surface that is lost in plain view in so many frames, and
  /// tracked in none between, is modelled anew, under the same id.
  int max_lost = 3;

  PipelineOptions();
  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
  /// @throw InputError if a value is out of its range.
  void Check() const;

 private:
  /// When surfaces begin, are tracked, found again and begun anew.
  void ListBounds(OptionList* list);
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_PIPELINE_OPTIONS_H_
