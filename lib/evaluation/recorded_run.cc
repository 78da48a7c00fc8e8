#include "splitfusion/lib/evaluation/recorded_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/deformation/graph_file.h"
#include "splitfusion/lib/deformation/motion_file.h"
#include "splitfusion/lib/sequence/calibration.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// Frames by the rows of the trajectory alone.
std::vector<RecordedFrame> FramesOfTrajectory(const std::string& path) {
  std::vector<RecordedFrame> frames;
  for (const TimedPose& pose : ReadTumTrajectory(path)) {
    frames.push_back({static_cast<int>(frames.size()), pose, ""});
  }
  if (frames.empty()) throw InputError(path + ": no pose: expected some");
  return frames;
}

/// @throw InputError if a line is about another frame than the pose is.
void CheckTimestamp(const std::string& place, double timestamp,
                    const TimedPose& pose) {
  constexpr double kTolerance = 1e-4;  // Seconds; the text has six decimals.
  if (std::abs(timestamp - pose.timestamp) < kTolerance) return;
  throw InputError(place + ": timestamp " + std::to_string(timestamp) +
                   ": expected " + std::to_string(pose.timestamp) +
                   " as in trajectory.txt");
}

/// Sets index and stem of a frame from its line of frames.jsonl.
void ReadFrameLine(const std::string& place, const std::string& line,
                   RecordedFrame* frame) {
  try {
    const auto json = nlohmann::json::parse(line);
    frame->index = json.at("frame").get<int>();
    frame->stem = json.at("stem").get<std::string>();
    CheckTimestamp(place, json.value("timestamp", frame->pose.timestamp),
                   frame->pose);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(place + ": expected an object with 'frame' and 'stem' (" +
                     error.what() + ")");
  }
}

/// @throw InputError unless every frame has a higher index than the last.
void CheckAscending(const std::string& path,
                    const std::vector<RecordedFrame>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const int least = i == 0 ? 0 : frames[i - 1].index + 1;
    if (frames[i].index >= least) continue;
    throw InputError(path + ":" + std::to_string(i + 1) + ": frame " +
                     std::to_string(frames[i].index) + ": expected " +
                     std::to_string(least) + " or more, frames ascend");
  }
}

void ReadFrameLines(const std::string& path,
                    std::vector<RecordedFrame>* frames) {
  std::ifstream stream(path);
  if (!stream) return;
  std::size_t count = 0;
  for (std::string line; std::getline(stream, line); ++count) {
    if (count < frames->size()) {
      ReadFrameLine(path + ":" + std::to_string(count + 1), line,
                    &(*frames)[count]);
    }
  }
  if (count != frames->size()) {
    throw InputError(path + ": " + std::to_string(count) +
                     " lines: expected one for each of the " +
                     std::to_string(frames->size()) +
                     " poses of trajectory.txt");
  }
  CheckAscending(path, *frames);
}

/// The value of a flag in a flagfile; empty if there is none.
std::string FlagValue(const std::string& path, const std::string& name) {
  std::ifstream stream(path);
  const std::string flag = "--" + name + "=";
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind(flag, 0) == 0) return line.substr(flag.size());
  }
  return "";
}

/// Sets an option by its flag if the flagfile has it.
void ReadFlag(const std::string& path, Option option) {
  const std::string text = FlagValue(path, option.name);
  if (text.empty()) return;
  try {
    option.Set(text);
  } catch (const OptionError& error) {
    throw InputError(path + ": --" + option.name + "=" + text + ": expected " +
                     error.expected());
  }
}

/// Sets the sequence, and how it is read, from the files of the run.
void ReadSource(const fs::path& root, RecordedRun* run) {
  const std::string flags = (root / "options.flags").string();
  run->sequence = FlagValue(flags, "sequence");
  ReaderOptions& reading = run->reading;
  const std::string format = FlagValue(flags, "format");
  if (!format.empty()) reading.format = format;
  OptionList scale;
  scale.Number("depth_scale", &reading.depth_scale, Range::AtLeast(0), "", "");
  ReadFlag(flags, scale.options().front());
  OptionList depth;
  reading.depth.List(&depth);
  for (const Option& option : depth.options()) ReadFlag(flags, option);
  std::optional<Calibration> found = FindCalibration(root.string());
  if (found) {
    reading.depth_scale = found->depth_scale;
  } else if (!run->sequence.empty() && FlagValue(flags, "intrinsics").empty()) {
    // Intrinsics of the command line overrule those beside the sequence.
    found = FindCalibration(run->sequence);
  }
  if (!found) return;
  run->camera = reading.camera = found->camera;
  run->camera->noise = reading.depth.noise;
}

std::vector<RecordedSurface> ReadSurfaces(const fs::path& folder) {
  std::set<std::string> names;
  if (fs::is_directory(folder)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (entry.is_directory()) names.insert(entry.path().string());
    }
  }
  std::vector<RecordedSurface> surfaces;
  for (const std::string& name : names) {
    surfaces.push_back(ReadRecordedSurface(name));
  }
  std::sort(surfaces.begin(), surfaces.end(),
            [](const RecordedSurface& a, const RecordedSurface& b) {
              return a.id < b.id;
            });
  return surfaces;
}

/// Sets id and label from the folder name NNN_LABEL.
void ParseName(const fs::path& folder, RecordedSurface* surface) {
  const std::string name = folder.filename().string();
  const std::size_t digits =
      std::min(name.find_first_not_of("0123456789"), name.size());
  if (digits == 0 || digits > 9 || digits == name.size() ||
      name[digits] != '_') {
    throw InputError(folder.string() + ": expected a name NNN_LABEL");
  }
  surface->id = std::stoi(name.substr(0, digits));
  surface->label = name.substr(digits + 1);
}

void CheckVertices(const std::string& path, const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (mesh.vertices[i].allFinite()) continue;
    throw InputError(path + ": vertex " + std::to_string(i) +
                     " is not finite: expected metres");
  }
}

/// `nodes`: of which motions.bin tells.
void CheckMotions(const std::string& path, const RecordedSurface& surface,
                  int nodes) {
  const DeformationGraph& graph = surface.graph;
  if (graph.size() == 0) throw InputError(path + ": graph.json has no node");
  if (nodes != graph.size() && !surface.motions.empty()) {
    throw InputError(path + ": motions.bin has " + std::to_string(nodes) +
                     " nodes: expected those of graph.json, " +
                     std::to_string(graph.size()));
  }
  for (const FrameMotions& frame : surface.motions) {
    if (frame.ranges.empty()) continue;  // It has all.
    for (int i = 0; i < nodes; ++i) {
      if (!graph.IsInUse(i, frame.frame) || frame.IndexOf(i) >= 0) continue;
      throw InputError(path + ": motions.bin has no motion of node " +
                       std::to_string(i) + " in frame " +
                       std::to_string(frame.frame) +
                       ": expected one, as graph.json has it in use");
    }
  }
}

/// Nothing here reads the volume, but one that is lost or was overwritten is to
/// be noticed: by its first eight bytes.
///
/// @throw InputError if they are not those of an OpenVDB file.
void CheckVolume(const std::string& path) {
  constexpr char kMagic[] = " BDV\0\0\0\0";
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path + ": cannot be opened");
  std::string head(sizeof(kMagic) - 1, '?');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (stream && head == std::string(kMagic, sizeof(kMagic) - 1)) return;
  throw InputError(path + ": expected an OpenVDB file");
}

}  // namespace

const RecordedFrame* RecordedRun::Find(int frame) const {
  const auto found = std::find_if(
      frames.begin(), frames.end(),
      [frame](const RecordedFrame& item) { return item.index == frame; });
  return found != frames.end() ? &*found : nullptr;
}

Trajectory RecordedRun::EstimatedTrajectory() const {
  Trajectory trajectory;
  for (const RecordedFrame& frame : frames) trajectory.push_back(frame.pose);
  return trajectory;
}

RecordedSurface ReadRecordedSurface(const std::string& folder) {
  const fs::path path(folder);
  RecordedSurface surface;
  ParseName(path, &surface);
  surface.mesh = ReadPly((path / "mesh.ply").string());
  CheckVertices((path / "mesh.ply").string(), surface.mesh);
  surface.graph =
      ReadGraph((path / "graph.json").string(), &surface.neighbors_per_point);
  int nodes = 0;
  surface.motions = ReadMotions((path / "motions.bin").string(), &nodes);
  CheckMotions(folder, surface, nodes);
  CheckVolume((path / "tsdf.vdb").string());
  return surface;
}

RecordedRun ReadRun(const std::string& root) {
  const fs::path path(root);
  if (!fs::is_directory(path)) {
    throw InputError(root + ": expected the directory of a run");
  }
  RecordedRun run;
  run.root = root;
  run.frames = FramesOfTrajectory((path / "trajectory.txt").string());
  ReadFrameLines((path / "frames.jsonl").string(), &run.frames);
  ReadSource(path, &run);
  run.surfaces = ReadSurfaces(path / "surfaces");
  return run;
}

}  // namespace splitfusion
