#include "splitfusion/lib/deformation/graph_file.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/brief_json.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/format_version.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

std::vector<Eigen::Vector3d> Positions(const std::string& path,
                                       const Json& json) {
  std::vector<Eigen::Vector3d> positions;
  for (const Json& item : json) {
    const auto p = item.get<std::array<double, 3>>();
    positions.emplace_back(p[0], p[1], p[2]);
    if (!positions.back().cast<float>().allFinite()) {
      throw InputError(path + ": field 'positions': " + BriefJson(item) +
                       ": expected metres");
    }
  }
  return positions;
}

void CheckEdges(const std::string& path, const DeformationGraph& graph) {
  if (graph.neighbors.size() != graph.positions.size()) {
    throw InputError(path + ": 'edges' has " +
                     std::to_string(graph.neighbors.size()) +
                     " entries: expected one a node, " +
                     std::to_string(graph.positions.size()));
  }
  for (const std::vector<int>& neighbors : graph.neighbors) {
    for (const int j : neighbors) {
      if (j >= 0 && j < graph.size()) continue;
      throw InputError(path + ": 'edges' names node " + std::to_string(j) +
                       ": expected 0.." + std::to_string(graph.size() - 1));
    }
  }
}

/// A field that has an entry for every node or none at all.
void CheckEntries(const std::string& path, const std::string& field,
                  const Json& json, std::size_t nodes) {
  if (!json.is_array()) {
    throw InputError(path + ": field '" + field + "': " + BriefJson(json) +
                     ": expected an array");
  }
  if (json.size() == nodes || json.empty()) return;
  throw InputError(
      path + ": '" + field + "' has " + std::to_string(json.size()) +
      " entries: expected one a node, " + std::to_string(nodes) + ", or none");
}

std::vector<int> Frames(const std::string& path, const std::string& field,
                        const Json& json) {
  std::vector<int> frames;
  for (const Json& item : json) {
    const bool is_frame =
        item.is_number_unsigned() && item.get<std::uint64_t>() <= INT32_MAX;
    if (!is_frame) {
      throw InputError(path + ": field '" + field + "': " + BriefJson(item) +
                       ": expected a frame index");
    }
    frames.push_back(item.get<int>());
  }
  return frames;
}

std::vector<int> FirstSeen(const std::string& path, const Json& json,
                           std::size_t nodes) {
  CheckEntries(path, "first_seen", json, nodes);
  return Frames(path, "first_seen", json);
}

/// [first node, first frame, frame behind the last or null]; nothing if it is
/// something else.
std::optional<ModelPart> ParsePart(const Json& json) {
  const auto is_index = [](const Json& item) {
    return item.is_number_unsigned() && item.get<std::uint64_t>() <= INT32_MAX;
  };
  if (!json.is_array() || json.size() != 3 || !is_index(json[0]) ||
      !is_index(json[1]) || !(json[2].is_null() || is_index(json[2]))) {
    return std::nullopt;
  }
  return ModelPart{json[0], json[1],
                   json[2].is_null() ? ModelPart::kNoEnd : json[2].get<int>()};
}

/// Parts of all nodes, by ascending ones: [[node, frame, end], ...].
std::vector<ModelPart> Parts(const std::string& path, const Json& json,
                             int nodes) {
  std::vector<ModelPart> parts;
  bool good = json.is_array();
  for (const Json& item : json) {
    const std::optional<ModelPart> part = ParsePart(item);
    good = good && part && part->node < nodes &&
           part->first_frame < part->end_frame &&
           part->node >= (parts.empty() ? 0 : parts.back().node + 1) &&
           (part->node == 0 || !parts.empty());
    if (!good) break;
    parts.push_back(*part);
  }
  if (good) return parts;
  throw InputError(path + ": field 'parts': " + BriefJson(json) +
                   ": expected first nodes, ascending, from node 0, with first "
                   "frames and the frames behind the last");
}

/// A field, not a copy of it: copies are made as deep as the value is, which
/// may be too deep for the stack.
const Json& FieldOr(const Json& json, const char* field, const Json& missing) {
  const auto found = json.find(field);
  return found == json.end() ? missing : *found;
}

DeformationGraph ParseGraph(const std::string& path, const Json& json) {
  DeformationGraph graph;
  const char* field = "node_spacing";
  try {
    graph.node_spacing = json.at(field).get<double>();
    graph.positions = Positions(path, json.at(field = "positions"));
    graph.neighbors =
        json.at(field = "edges").get<std::vector<std::vector<int>>>();
  } catch (const Json::exception& error) {
    throw InputError(path + ": field '" + field + "': " + error.what());
  }
  if (!std::isfinite(graph.node_spacing) || graph.node_spacing < 0) {
    throw InputError(
        path + ": field 'node_spacing': " + std::to_string(graph.node_spacing) +
        ": expected metres >= 0");
  }
  graph.motions.resize(graph.positions.size());
  CheckEdges(path, graph);
  const Json none = Json::array();
  graph.first_seen = FirstSeen(path, FieldOr(json, "first_seen", none),
                               graph.positions.size());
  // Without their parts all models of a surface would be shown at once.
  if (!FieldOr(json, "models", none).empty()) {
    throw InputError(path +
                     ": field 'models': expected a run of this version, which "
                     "has 'parts'");
  }
  graph.parts = Parts(path, FieldOr(json, "parts", none), graph.size());
  return graph;
}

int ParseNeighborsPerPoint(const std::string& path, const Json& json) {
  const auto found = json.find("neighbors_per_point");
  if (found == json.end() || !found->is_number_integer()) {
    throw InputError(path +
                     ": field 'neighbors_per_point': expected an integer");
  }
  return found->get<int>();
}

}  // namespace

void WriteGraph(const std::string& path, const DeformationGraph& graph,
                int neighbors_per_point) {
  Json positions = Json::array();
  for (const Eigen::Vector3d& g : graph.positions) {
    positions.push_back({g.x(), g.y(), g.z()});
  }
  Json parts = Json::array();
  for (const ModelPart& part : graph.parts) {
    const bool ends = part.end_frame != ModelPart::kNoEnd;
    parts.push_back(
        {part.node, part.first_frame, ends ? Json(part.end_frame) : Json()});
  }
  const Json json = {{"format_version", kFormatVersion},
                     {"node_spacing", graph.node_spacing},
                     {"neighbors_per_point", neighbors_per_point},
                     {"positions", positions},
                     {"edges", graph.neighbors},
                     {"first_seen", graph.first_seen},
                     {"parts", parts}};
  WriteFileAtomically(path, [&](std::ostream& out) { out << json << '\n'; });
}

DeformationGraph ReadGraph(const std::string& path, int* neighbors_per_point) {
  std::ifstream stream(path);
  if (!stream) throw InputError(path + ": cannot be opened");
  const Json json = Json::parse(stream, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) {
    throw InputError(path +
                     ": expected a JSON object with node_spacing, "
                     "neighbors_per_point, positions, edges");
  }
  CheckFormatVersion(path, json);
  if (neighbors_per_point != nullptr) {
    *neighbors_per_point = ParseNeighborsPerPoint(path, json);
  }
  return ParseGraph(path, json);
}

}  // namespace splitfusion
