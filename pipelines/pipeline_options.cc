#include "splitfusion/pipelines/pipeline_options.h"

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {

PipelineOptions::PipelineOptions() {
  background.tsdf.voxel_size = 0.010;
  background.tsdf.truncation = 0.040;
  background.tsdf.reach_sigmas = 3;
  object.tsdf.voxel_size = 0.005;
  object.tsdf.truncation = 0.030;
  object.min_piece_area = 0.0025;
}

void PipelineOptions::List(OptionList* list) {
  list->Text(
          "terms", &terms,
          "The energy, Eq. 4: NAME(KEY=VALUE,...) ..., keys by --help_terms.")
      .common = true;
  list->Switch("split_scene", &split_scene,
               "Split the scene; otherwise one surface holds all of it.");
  list->Switch("model_objects", &model_objects,
               "Model what moves; otherwise it is only cut out.");
  list->Switch("deform_objects", &deform_objects,
               "What moves deforms; otherwise it is rigid.");
  list->Switch("deform_background", &deform_background,
               "The background deforms, too.");
  list->Number("render_stride", &render_stride, {1, 8}, "pixels",
               "Model maps hold every n-th pixel; divides the stride of every "
               "tracking stage, so 1 or 2.");
  for (const auto& stages : {tracker.RigidStages(), tracker.NonRigidStages()}) {
    for (const TrackingStage& stage : stages) {
      list->Demand(render_stride < 1 || stage.stride % render_stride == 0,
                   "render_stride",
                   "a divisor of the stride of every tracking stage (" +
                       std::to_string(stage.stride) + ")");
    }
  }
  ListBounds(list);
  list->Part("normal_", &point_map);
  list->Part("", &graph);
  list->Part("background_", &background);
  list->Part("object_", &object);
  list->Part("", &tracker);
  list->Part("", &point_tracks);
  list->Part("", &match);
  list->Part("key_frame_", &key_frames);
  list->Number("unusual_misfit", &unusual_misfit, Range::AtLeast(1), "",
               "The camera is looked for where the background fits so many "
               "times as badly as usual.");
  list->Switch("close_loops", &close_loops,
               "Once all frames are known, correct the drift of a camera that "
               "came back to where it was, and if poses change by more than a "
               "voxel fuse all frames anew.");
  list->Demand(match.feature_model.empty() ||
                   (match.features && tracker.part_start.parts.count > 0),
               "feature_model",
               "an empty one, or --match_features and --parts above 0");
  list->Part("", &solver);
  list->Part("", &hidden);
  list->Switch("best_view_colors", &best_view_colors,
               "Once all frames are known, colour vertices from the frames "
               "that show them well, instead of what fusion made of it.");
  list->Part("", &split);
  list->Part("ray_", &ray_cast);
}

void PipelineOptions::ListBounds(OptionList* list) {
  list->Number("min_tracked_pixels", &min_tracked_pixels, Range::AtLeast(1),
               "pixels", "A surface with fewer pixels in view is not tracked.");
  list->Number("min_exposure", &min_exposure, Range::Share(), "",
               "With a smaller visible fraction a surface is occluded: "
               "predicted, not tracked; 0 = never.");
  list->Number("min_coverage", &min_coverage, Range::Share(), "",
               "A surface that was lost or hidden is found only if its paired "
               "model points are this share of its live pixels (edges apart); "
               "0 = not asked.");
  list->Switch("last_sights", &last_sights,
               "A surface that was lost or hidden is looked for by features of "
               "its last sight in plain view, too.");
  list->Number(
      "own_motion_gain", &own_motion_gain, {0, kNoiseSigmas * kNoiseSigmas},
      "variances of the noise",
      "A detection of a rigid class moves, and is no background any more, if a "
      "motion of its own lowers the mean squared distance of its mapped points "
      "to the depth by so much; 0 = not looked for.");
  list->Number("min_birth_area", &min_birth_area, {0, 1, false, true},
               "of the image", "A surface is modelled once it covers as much.");
  list->Number("max_lost", &max_lost, Range::AtLeast(1), "frames",
               "A deforming surface that is lost in plain view in so many "
               "frames, and tracked in none between, is modelled anew, under "
               "the same id.");
}

void PipelineOptions::Check() const {
  CheckOptions(*this);
  split.Check();
}

}  // namespace splitfusion
