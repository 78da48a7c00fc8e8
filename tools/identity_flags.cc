#include "identity_flags.h"

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "method_flags.h"
#include "run_flags.h"
#include "splitfusion/cost_functions/published_energies.h"
#include "splitfusion/lib/base/content_cache.h"
#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/base/number_text.h"
#include "splitfusion/lib/base/owned_files.h"
#include "splitfusion/lib/energy/surface_energies.h"
#include "splitfusion/lib/experiment/settings.h"
#include "splitfusion/lib/report/library_versions.h"
#include "splitfusion/lib/report/run_paths.h"
#include "splitfusion/lib/segmentation/mask_folder_segmenter.h"

DEFINE_string(set, "", "KEY=VALUE; ...: flags, [CLASS.]terms.arap.weight=4.");
DEFINE_string(energy, "", "Terms of a paper, by name; see docs/terms.md.");
DECLARE_string(class_names);
DECLARE_int32(at);
DECLARE_string(from);
DECLARE_string(labels);
DECLARE_string(masks);
DECLARE_string(model);
DECLARE_string(sequence);
DECLARE_string(trajectory);

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// Flags that say where something is, whose content counts instead, or that
/// leave the result as it is.
const std::set<std::string>& Uncounted() {
  static const std::set<std::string> names = {
      "checkpoint_every", "class_names", "color_camera",   "energy",
      "feature_model",    "keep_same",   "labels",         "masks",
      "max_frames",       "model",       "output",         "resume",
      "overwrite",        "help_terms",  "print_identity", "print_options",
      "sequence",         "set",         "terms",          "terms_library",
      "threads",          "trajectory",  "intrinsics",     "depth_scale",
      "skip_bad_frames",  "from"};
  return names;
}

/// Flags of what is written about a result.
const std::set<std::string>& Outputs() {
  static const std::set<std::string> names = {
      "covariance",     "freeze",       "full_report",  "keep_checkpoints",
      "pictures_every", "warped_every", "warped_whole", "write_masks"};
  return names;
}

/// A number as short as it reads back exactly; other values as they are.
std::string ValueText(const gflags::CommandLineFlagInfo& flag,
                      const std::string& value) {
  return flag.type == "double" ? NumberText(std::stod(value)) : value;
}

void AddFlags(RunIdentity* identity) {
  std::vector<gflags::CommandLineFlagInfo> flags;
  gflags::GetAllFlags(&flags);
  for (const gflags::CommandLineFlagInfo& flag : flags) {
    if (!IsRunFlag(flag)) continue;
    if (Outputs().count(flag.name) > 0) {
      identity->outputs[flag.name] = ValueText(flag, flag.current_value);
    } else if (Uncounted().count(flag.name) == 0) {
      const std::string value = ValueText(flag, flag.current_value);
      const std::string common = ValueText(flag, flag.default_value);
      identity->parts[flag.name] = value;
      if (value != common) identity->defaults[flag.name] = common;
    }
  }
}

/// The options of an energy, and the order of its terms.
NamedValues TermParts(const std::string& text, const TermRegistry& terms) {
  const SurfaceEnergies energies = SurfaceEnergies::Parse(text, terms);
  NamedValues parts = energies.OptionValues();
  std::string order;
  for (const WeightedTerm& term : energies.all()) {
    order += (order.empty() ? "" : " ") + term.options.name;
  }
  parts["terms"] = order;
  return parts;
}

void AddTerms(const TermRegistry& terms, RunIdentity* identity) {
  NamedValues parts = TermParts(MethodFlags().terms, terms);
  NamedValues common = TermParts(PipelineOptions().terms, terms);
  for (const auto& [name, value] : parts) {
    if (common[name] != value) identity->defaults[name] = common[name];
    common.erase(name);
  }
  identity->defaults.merge(common);  // Of terms that are not there.
  identity->parts.merge(parts);
}

}  // namespace

NamedValues InputParts(const ImageFolderReader& reader) {
  NamedValues parts;
  std::vector<std::string> files;
  ContentHash hash;
  for (const AssociatedFiles& pair : reader.pairs()) {
    files.push_back(pair.color.file);
    files.push_back(pair.depth.file);
    hash.Add(NumberText(pair.depth.timestamp));
  }
  const ContentCache cache(UserCacheFolder());
  // A file that holds all is one file.
  const fs::path sequence = reader.folder();
  hash.Add(fs::is_regular_file(sequence)
               ? cache.HashOfFiles(sequence.parent_path().string(),
                                   {sequence.filename().string()})
               : cache.HashOfFiles(reader.folder(), files));
  parts["input.frame_count"] = std::to_string(reader.size());
  parts["input.frames"] = hash.Hex();
  const Calibration& used = reader.calibration();
  std::string camera;
  for (const double value : {used.camera.fx, used.camera.fy, used.camera.cx,
                             used.camera.cy, double(used.camera.width),
                             double(used.camera.height), used.depth_scale}) {
    camera += (camera.empty() ? "" : " ") + NumberText(value);
  }
  parts["input.camera"] = camera;
  parts["input.color_camera"] =
      used.color ? ToText(*used.color) : reader.options().color_camera;
  const std::optional<double>& rows = reader.options().rolling_shutter;
  parts["input.rolling_shutter"] = rows ? NumberText(*rows) : "auto";
  if (!used.lens.IsNone()) parts["input.lens"] = used.lens.Text();
  if (used.color && !used.color_lens.IsNone()) {
    parts["input.color_lens"] = used.color_lens.Text();
  }
  return parts;
}

namespace {

/// Content of a file that a flag names; "none" without one.
std::string FileHash(const std::string& path) {
  return path.empty() ? "none" : HashOfFile(path);
}

std::string MasksHash(const ContentCache& cache) {
  if (!FLAGS_model.empty() || FLAGS_masks == "none" || FLAGS_masks.empty()) {
    return "none";
  }
  const std::string folder =
      FLAGS_masks == "auto" ? FindMaskFolder(FLAGS_sequence) : FLAGS_masks;
  if (folder.empty()) return "none";
  std::vector<std::string> files;
  for (const OwnedFile& file : FilesBelow(folder)) files.push_back(file.path);
  return cache.HashOfFiles(folder, files);
}

/// What decides the last digits besides the sources of the method.
std::string LibrariesHash() {
  ContentHash hash;
  for (const auto& [library, version] : LibraryVersions()) {
    hash.Add(library).Add(version);
  }
  return hash.Hex();
}

void SetFlag(const std::string& key, const std::string& value) {
  // Some are read before it.
  static const std::set<std::string> not_set = {
      "set",           "output",         "terms_library",
      "print_options", "print_identity", "help_terms"};
  gflags::CommandLineFlagInfo flag;
  if (not_set.count(key) > 0) {
    throw InputError("--set: key '" + key + "': expected as a flag, --" + key);
  }
  const bool known =
      gflags::GetCommandLineFlagInfo(key.c_str(), &flag) && IsRunFlag(flag);
  if (!known) {
    throw InputError("--set: key '" + key +
                     "': expected a flag of sf_run, terms.NAME.KEY "
                     "(sf_run --help_terms), or CLASS.terms.NAME.KEY");
  }
  if (gflags::SetCommandLineOption(key.c_str(), value.c_str()).empty()) {
    throw InputError("--set: " + key + " = " + value + ": expected a value " +
                     "of type " + flag.type);
  }
}

/// Puts the terms of --energy in the place of the default ones. The options
/// that repeat the run have it resolved, as those of --set.
void ApplyEnergyFlag() {
  if (FLAGS_energy.empty()) return;
  const std::string terms = PublishedTerms(FLAGS_energy);
  if (gflags::GetCommandLineFlagInfoOrDie("terms").is_default) {
    MethodFlags().terms = terms;
  } else {
    LOG(WARNING) << "--energy=" << FLAGS_energy << ": --terms beats it";
  }
  FLAGS_energy.clear();
}

}  // namespace

void ApplySetFlag(const TermRegistry& terms) {
  if (FLAGS_set.empty()) return ApplyEnergyFlag();
  const Settings settings = ParseSettings(FLAGS_set, "set");
  for (const auto& [key, value] : settings.entries()) {
    if (!IsTermKey(key)) SetFlag(key, value);
  }
  ApplyEnergyFlag();
  SurfaceEnergies energies = SurfaceEnergies::Parse(MethodFlags().terms, terms);
  bool changed = false;
  for (const auto& [key, value] : settings.entries()) {
    if (!IsTermKey(key)) continue;
    energies.Set(key, value, terms);
    changed = true;
  }
  if (changed) MethodFlags().terms = energies.Text();
  FLAGS_set.clear();  // The options that repeat the run have it resolved.
}

RunIdentity IdentityFromFlags(const ImageFolderReader& reader,
                              const TermRegistry& terms) {
  const ContentCache cache(UserCacheFolder());
  RunIdentity identity;
  AddFlags(&identity);
  AddTerms(terms, &identity);
  identity.parts.merge(InputParts(reader));
  identity.parts["input.masks"] = MasksHash(cache);
  identity.parts["input.trajectory"] = FileHash(FLAGS_trajectory);
  identity.parts["input.labels"] = FileHash(FLAGS_labels);
  identity.parts["input.from"] = FileHash(
      FLAGS_from.empty() ? "" : RunPaths(FLAGS_from).KeptCheckpoint(FLAGS_at));
  identity.parts["input.feature_model"] =
      FileHash(MethodFlags().match.feature_model);
  identity.parts["input.model"] = FileHash(FLAGS_model);
  identity.parts["input.class_names"] = FileHash(FLAGS_class_names);
  identity.parts["method"] = MethodHash();
  identity.parts["libraries"] = LibrariesHash();
  return identity;
}

std::string IdentityText(const RunIdentity& identity) {
  const nlohmann::ordered_json json = {{"identity", identity.Hash()},
                                       {"identity_parts", identity.parts},
                                       {"defaults", identity.defaults},
                                       {"outputs", identity.outputs}};
  return JsonText(json, 1) + "\n";
}

}  // namespace splitfusion
