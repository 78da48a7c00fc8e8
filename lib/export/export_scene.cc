#include "splitfusion/lib/export/export_scene.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/evaluation/recorded_run.h"
#include "splitfusion/lib/model/part_motions.h"
#include "splitfusion/lib/report/json_lines.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {
namespace {

/// Pairs of surface and frame index in which frames.jsonl says `inactive`.
using Absences = std::set<std::pair<int, int>>;

/// A part of a surface that is exported as one mesh: nodes from `begin` to
/// before `end`, in use in frames from `first_frame` to before `end_frame`.
struct PartOfSurface {
  int begin = 0;
  int end = 0;
  int first_frame = 0;
  int end_frame = ModelPart::kNoEnd;
  bool refuted = false;
};

Absences ReadAbsences(const RunPaths& paths) {
  Absences absences;
  if (!std::filesystem::exists(paths.Frames())) return absences;
  for (const auto& line : ReadJsonLines(paths.Frames())) {
    try {
      if (!line.contains("surfaces")) continue;
      for (const auto& surface : line["surfaces"]) {
        if (surface.at("state").get<std::string>() != "inactive") continue;
        absences.emplace(surface.at("id").get<int>(),
                         line.at("frame").get<int>());
      }
    } catch (const nlohmann::json::exception& error) {
      throw InputError(paths.Frames() +
                       ": expected 'frame', and of every surface 'id' and "
                       "'state' (" +
                       error.what() + ")");
    }
  }
  return absences;
}

/// The parts of a graph.
std::vector<PartOfSurface> PartsOf(const DeformationGraph& graph) {
  if (graph.parts.empty()) return {{0, graph.size()}};
  const std::vector<char> refuted = WhichWereRefuted(graph);
  std::vector<PartOfSurface> parts;
  for (std::size_t i = 0; i < graph.parts.size(); ++i) {
    const ModelPart& part = graph.parts[i];
    parts.push_back({part.node, graph.EndOfPart(i), part.first_frame,
                     part.end_frame, refuted[i] != 0});
  }
  return parts;
}

/// `_1`, `_2` where there are several models, `_refuted_1`, ... of others.
std::vector<std::string> SuffixesOf(const std::vector<PartOfSurface>& parts) {
  const auto models = std::count_if(parts.begin(), parts.end(),
                                    [](const auto& p) { return !p.refuted; });
  std::vector<std::string> suffixes;
  int model = 0, refuted = 0;
  for (const PartOfSurface& part : parts) {
    if (part.refuted) {
      suffixes.push_back("_refuted_" + std::to_string(++refuted));
    } else {
      suffixes.push_back(models == 1 ? "" : "_" + std::to_string(++model));
    }
  }
  return suffixes;
}

/// Nodes of a part as a graph of their own.
DeformationGraph GraphOf(const DeformationGraph& all,
                         const PartOfSurface& part) {
  DeformationGraph graph;
  graph.node_spacing = all.node_spacing;
  const auto cut = [&](const auto& from, auto* to) {
    to->assign(from.begin() + part.begin, from.begin() + part.end);
  };
  cut(all.positions, &graph.positions);
  cut(all.neighbors, &graph.neighbors);
  if (static_cast<int>(all.first_seen.size()) == all.size()) {
    cut(all.first_seen, &graph.first_seen);
  }
  for (std::vector<int>& neighbors : graph.neighbors) {
    for (int& node : neighbors) node -= part.begin;
  }
  return graph;
}

/// Sets mesh, source and skinning of `surface` to what a part carries.
void TakeVertices(const RecordedSurface& recorded,
                  const std::vector<Skinning>& skinning,
                  const PartOfSurface& part, ExportSurface* surface) {
  const TriangleMesh& all = recorded.mesh;
  std::vector<int> place(all.vertices.size(), -1);
  for (std::size_t i = 0; i < place.size(); ++i) {
    Skinning one = skinning[i];
    if (one.nodes[0] < part.begin || one.nodes[0] >= part.end) continue;
    for (int k = 0; k < one.count; ++k) {
      if (one.nodes[k] >= part.end) {
        throw InputError(surface->name +
                         ": an edge of graph.json joins nodes " +
                         "of two parts: expected none");
      }
      one.nodes[k] -= part.begin;
    }
    place[i] = static_cast<int>(surface->source.size());
    surface->source.push_back(static_cast<int>(i));
    surface->skinning.push_back(one);
    surface->mesh.vertices.push_back(all.vertices[i]);
    if (!all.normals.empty()) surface->mesh.normals.push_back(all.normals[i]);
    if (!all.colors.empty()) surface->mesh.colors.push_back(all.colors[i]);
  }
  for (const Eigen::Vector3i& t : all.triangles) {
    const Eigen::Vector3i corners(place[t[0]], place[t[1]], place[t[2]]);
    if (corners.minCoeff() >= 0) surface->mesh.triangles.push_back(corners);
  }
}

/// Sets the moments of `surface`, where the part is there.
void TakeMotions(const RecordedSurface& recorded, const PartOfSurface& part,
                 const std::vector<ExportFrame>& frames,
                 const Absences& absences, ExportSurface* surface) {
  DeformationGraph moved;
  moved.positions = surface->graph.positions;
  for (std::size_t place = 0; place < frames.size(); ++place) {
    const int index = frames[place].index;
    if (index < part.first_frame || index >= part.end_frame ||
        absences.count({recorded.id, index}) > 0) {
      continue;
    }
    const std::optional<FrameMotions> motions = recorded.motions.Find(index);
    if (!motions) continue;
    const auto first = motions->motions.begin() + motions->IndexOf(part.begin);
    moved.motions.assign(first, first + (part.end - part.begin));
    ApplyRigidMotion(frames[place].space_from_camera, &moved);
    surface->moments.push_back({place, index, motions->tracked, moved.motions});
  }
}

/// What is exported of a surface; nothing that is in no frame or has no vertex.
std::vector<ExportSurface> SurfacesOf(const RecordedSurface& recorded,
                                      const std::vector<ExportFrame>& frames,
                                      const Absences& absences,
                                      const ExportOptions& options) {
  const std::vector<Skinning> skinning =
      SkinningIndex(recorded.graph, recorded.neighbors_per_point)
          .Skin(recorded.mesh.vertices);
  const std::vector<PartOfSurface> parts = PartsOf(recorded.graph);
  const std::vector<std::string> suffixes = SuffixesOf(parts);
  std::vector<ExportSurface> surfaces;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].refuted && !options.refuted) continue;
    ExportSurface surface;
    surface.id = recorded.id;
    surface.label = recorded.label;
    surface.name =
        RunPaths::SurfaceName(recorded.id, recorded.label) + suffixes[i];
    surface.graph = GraphOf(recorded.graph, parts[i]);
    TakeVertices(recorded, skinning, parts[i], &surface);
    TakeMotions(recorded, parts[i], frames, absences, &surface);
    if (surface.moments.empty() || surface.mesh.vertices.empty()) continue;
    if (options.cut_stretched) LeaveStretchedOut(&surface);
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

std::vector<ExportFrame> FramesOf(const RecordedRun& run,
                                  const ExportOptions& options) {
  Rigid3d up = Rigid3d::Identity();
  if (options.y_up) up.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  std::vector<ExportFrame> frames;
  for (const RecordedFrame& frame : run.frames) {
    if (frame.index % options.every != 0) continue;
    const Rigid3d& pose = frame.pose.world_from_camera;
    frames.push_back({frame.index, frame.pose.timestamp,
                      options.in_world ? up * pose : up, pose});
  }
  if (!frames.empty()) return frames;
  throw InputError(run.root + ": no frame is a multiple of " +
                   std::to_string(options.every) + ": expected some");
}

/// @throw InputError if a surface that is asked for is not there.
void CheckSurfaces(const RecordedRun& run, const ExportOptions& options) {
  std::set<int> ids;
  std::string list;
  for (const RecordedSurface& surface : run.surfaces) {
    ids.insert(surface.id);
    list += (list.empty() ? "" : ", ") + std::to_string(surface.id);
  }
  for (const int id : options.surfaces) {
    if (ids.count(id) > 0) continue;
    throw InputError(run.root + ": surface " + std::to_string(id) +
                     ": expected one of " + list);
  }
}

}  // namespace

void ExportOptions::Check() const {
  CheckOption(every >= 1, "every", every, ">= 1");
}

ExportScene ReadExportScene(const std::string& run,
                            const ExportOptions& options) {
  options.Check();
  RecordedRun recorded = ReadRun(run);
  CheckSurfaces(recorded, options);
  ExportScene scene;
  scene.run = run;
  scene.y_up = options.y_up;
  scene.in_world = options.in_world;
  scene.frames = FramesOf(recorded, options);
  scene.camera = recorded.camera;
  const Absences absences = ReadAbsences(RunPaths(run));
  const std::vector<int>& wanted = options.surfaces;
  for (RecordedSurface& surface : recorded.surfaces) {
    if (wanted.empty() ||
        std::find(wanted.begin(), wanted.end(), surface.id) != wanted.end()) {
      std::vector<ExportSurface> shown =
          SurfacesOf(surface, scene.frames, absences, options);
      if (shown.empty()) {
        scene.absent.push_back(
            RunPaths::SurfaceName(surface.id, surface.label));
      }
      std::move(shown.begin(), shown.end(), std::back_inserter(scene.surfaces));
    }
    surface = {};  // Its motions take much memory.
  }
  return scene;
}

}  // namespace splitfusion
