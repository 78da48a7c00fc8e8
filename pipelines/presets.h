#ifndef SPLITFUSION_PIPELINES_PRESETS_H_
#define SPLITFUSION_PIPELINES_PRESETS_H_

#include <string>
#include <vector>

#include "splitfusion/pipelines/pipeline_options.h"

namespace splitfusion {

/// Names of the presets: the method, what it can do faster, and the baselines
/// that the paper compares it with, all from the same code.
std::vector<std::string> PresetNames();

/// Sets the options in which a preset differs from the method:
///   splitfusion      rigid background, non-rigid objects (SplitFusion)
///   online           the same in about 3/4 of the time: people at 7 mm
///                    voxels, no rigid parts, rigid stages end earlier
///   kinectfusion     no split, one rigid surface (Newcombe et al. 2011)
///   dynamicfusion    no split, one non-rigid surface (Newcombe et al. 2015)
///   cofusion         split, every surface rigid (Runz and Agapito 2017)
///   background_only  moving things cut out, only the background modelled
///
/// @throw InputError on an unknown name; lists the known ones.
void ApplyPreset(const std::string& name, PipelineOptions* options);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_PRESETS_H_
