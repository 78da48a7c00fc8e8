#include "splitfusion/pipelines/presets.h"

#include <functional>
#include <map>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

using Change = std::function<void(PipelineOptions*)>;

const std::map<std::string, Change>& Presets() {
  static const std::map<std::string, Change> presets = {
      {"splitfusion", [](PipelineOptions*) {}},
      {"online",
       [](PipelineOptions* o) {
         o->object.tsdf.voxel_size = 0.007F;
         o->tracker.settled = 0.01;
         o->tracker.part_start.parts.count = 0;
         o->hidden.refine = false;
         o->best_view_colors = false;
         o->close_loops = false;
       }},
      {"kinectfusion", [](PipelineOptions* o) { o->split_scene = false; }},
      {"dynamicfusion",
       [](PipelineOptions* o) {
         o->split_scene = false;
         o->deform_background = true;
         o->close_loops = false;
         o->terms = PipelineOptions::kDeformingTerms;
       }},
      {"cofusion", [](PipelineOptions* o) { o->deform_objects = false; }},
      {"background_only",
       [](PipelineOptions* o) { o->model_objects = false; }}};
  return presets;
}

}  // namespace

std::vector<std::string> PresetNames() {
  std::vector<std::string> names;
  for (const auto& [name, change] : Presets()) names.push_back(name);
  return names;
}

void ApplyPreset(const std::string& name, PipelineOptions* options) {
  const auto found = Presets().find(name);
  std::string known;
  for (const std::string& n : PresetNames()) {
    known += (known.empty() ? "" : ", ") + n;
  }
  CheckOption(found != Presets().end(), "preset", name, known);
  found->second(options);
}

}  // namespace splitfusion
