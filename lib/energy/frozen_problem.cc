#include "splitfusion/lib/energy/frozen_problem.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/hdf5_file.h"
#include "splitfusion/lib/energy/block_problem.h"
#include "splitfusion/lib/energy/term_unknowns.h"

namespace splitfusion {
namespace {

constexpr int kVersion = 3;                             // Format.
constexpr int kOldestVersion = 1;                       // Format.
constexpr const char* kFormat = "splitfusion problem";  // Format.

/// A directed edge of the graph.
using Edge = std::array<std::int32_t, 2>;

/// Whether two costs are the same, but for the order of their sums.
bool AreEqual(double a, double b) {
  constexpr double kRounding = 1e-12;  // Maths.
  return std::abs(a - b) <= kRounding * std::max(std::abs(a), std::abs(b));
}

/// @throw InputError if a term looks beyond what is kept.
void CheckComplete(const FrozenProblem& problem,
                   const std::vector<double>& with_live) {
  const std::vector<double> without =
      EvaluateStart(problem.View(), problem.graph).terms;
  for (std::size_t i = 0; i < without.size(); ++i) {
    const std::string& name = problem.energy[i].options.name;
    if (!std::isfinite(with_live[i])) {
      throw InputError("term '" + name + "': its cost is not finite");
    }
    if (AreEqual(without[i], with_live[i])) continue;
    throw InputError("term '" + name +
                     "' looks at the live frame, its context, its state or "
                     "where its unknowns began: expected terms that do not, as "
                     "these are not kept in a frozen problem");
  }
}

// What writes and what reads are one function, so that they agree; `File`:
// Hdf5Writer or Hdf5Reader.

template <typename File>
void VisitMotions(File* file, const std::string& group,
                  std::vector<NodeMotion>* motions) {
  file->Column(
      group + "/rotation", motions,
      [](NodeMotion & m) -> auto& { return m.rotation; });
  file->Column(
      group + "/translation", motions,
      [](NodeMotion & m) -> auto& { return m.translation; });
}

/// Model points of correspondences or tracks.
template <typename File, typename Item>
void VisitModel(File* file, const std::string& group,
                std::vector<Item>* items) {
  const auto column = [&](const std::string& name, const auto& of) {
    file->Column(group + "/" + name, items, of);
  };
  column(
      "point", [](Item & i) -> auto& { return i.model.point; });
  column(
      "normal", [](Item & i) -> auto& { return i.model.normal; });
  column(
      "intensity", [](Item & i) -> auto& { return i.model.intensity; });
  column(
      "u", [](Item & i) -> auto& { return i.model.u; });
  column(
      "v", [](Item & i) -> auto& { return i.model.v; });
  column(
      "nodes", [](Item & i) -> auto& { return i.model.skinning.nodes; });
  column(
      "weights", [](Item & i) -> auto& { return i.model.skinning.weights; });
  column(
      "node_count", [](Item & i) -> auto& { return i.model.skinning.count; });
}

template <typename File>
void VisitPairs(File* file, const std::string& group,
                std::vector<Correspondence>* pairs) {
  using C = Correspondence;
  const auto column = [&](const std::string& name, const auto& of) {
    file->Column(group + "/" + name, pairs, of);
  };
  VisitModel(file, group, pairs);
  column(
      "warped_normal", [](C & c) -> auto& { return c.warped_normal; });
  column(
      "target", [](C & c) -> auto& { return c.target; });
  column(
      "target_normal", [](C & c) -> auto& { return c.target_normal; });
  column(
      "confidence", [](C & c) -> auto& { return c.weight; });
  column(
      "pixel", [](C & c) -> auto& { return c.pixel; });
  column(
      "intensity_difference",
      [](C & c) -> auto& { return c.intensity_difference; });
  column(
      "intensity_gradient",
      [](C & c) -> auto& { return c.intensity_gradient; });
  if (!file->Has(group + "/model_intensity", true)) return;  // Version 1.
  column(
      "model_intensity", [](C & c) -> auto& { return c.model_intensity; });
}

template <typename File>
void VisitTracks(File* file, const std::string& group,
                 std::vector<TrackedPoint>* tracks) {
  VisitModel(file, group, tracks);
  file->Column(
      group + "/target", tracks,
      [](TrackedPoint & t) -> auto& { return t.target; });
  file->Column(
      group + "/confidence", tracks,
      [](TrackedPoint & t) -> auto& { return t.weight; });
}

/// What may be missing, by `visit`.
template <typename File, typename T, typename Visit>
void VisitOptional(File* file, const std::string& group,
                   std::optional<std::vector<T>>* values, const Visit& visit) {
  if (!file->Has(group, values->has_value())) return;
  if (!values->has_value()) values->emplace();
  visit(file, group, &**values);
}

template <typename File>
void VisitCamera(File* file, PinholeCamera* camera) {
  file->Attribute("width", &camera->width);
  file->Attribute("height", &camera->height);
  file->Attribute("fx", &camera->fx);
  file->Attribute("fy", &camera->fy);
  file->Attribute("cx", &camera->cx);
  file->Attribute("cy", &camera->cy);
  file->Attribute("noise_least", &camera->noise.least);
  file->Attribute("noise_growth", &camera->noise.growth);
  file->Attribute("noise_best", &camera->noise.best);
  file->Attribute("noise_reference", &camera->noise.reference);
}

template <typename File>
void VisitLinks(File* file, std::optional<LinksInTime>* links) {
  if (!file->Has("known", links->has_value())) return;
  if (!links->has_value()) links->emplace();
  file->Column("known/position", &(*links)->known_positions);
  VisitMotions(file, "known", &(*links)->known_motions);
  file->Column("hidden_edges/nodes", &(*links)->edges);
  file->Column("hidden_triples/nodes", &(*links)->triples);
  file->Column("hidden_triples/factors", &(*links)->differences);
}

/// Everything but the energy, which is a text, and the edges.
template <typename File>
void Visit(File* file, FrozenProblem* problem, std::vector<Edge>* edges) {
  file->Attribute("frame", &problem->frame);
  file->Attribute("surface", &problem->surface);
  file->Attribute("anneal", &problem->anneal);
  file->Attribute("initial_radius", &problem->initial_radius);
  file->Attribute("node_spacing", &problem->graph.node_spacing);
  file->Attribute("start_cost", &problem->start.cost);
  file->Attribute("solver", &problem->solver);
  file->Attribute("final_cost", &problem->final_cost);
  VisitCamera(file, &problem->camera);
  file->Column("graph/position", &problem->graph.positions);
  VisitMotions(file, "graph", &problem->graph.motions);
  file->Column("graph/start_gradient", &problem->start.gradient);
  file->Column("edges/nodes", edges);
  file->Column("terms/start_cost", &problem->start.terms);
  VisitPairs(file, "correspondences", &problem->correspondences);
  const auto motions = [](File* f, const std::string& group,
                          std::vector<NodeMotion>* values) {
    VisitMotions(f, group, values);
  };
  const auto pairs = [](File* f, const std::string& group,
                        std::vector<Correspondence>* values) {
    VisitPairs(f, group, values);
  };
  const auto tracks = [](File* f, const std::string& group,
                         std::vector<TrackedPoint>* values) {
    VisitTracks(f, group, values);
  };
  VisitOptional(file, "before", &problem->before, motions);
  VisitOptional(file, "lost", &problem->lost, pairs);
  VisitOptional(file, "tracks", &problem->tracks, tracks);
  VisitLinks(file, &problem->links);
  if (file->Has("unknowns", !problem->unknowns.empty())) {
    file->Column("unknowns/start", &problem->unknowns);
    file->Column("unknowns/start_gradient", &problem->start.by_unknowns);
  }
}

std::vector<Edge> EdgesOf(const DeformationGraph& graph) {
  std::vector<Edge> edges;
  for (int i = 0; i < graph.size(); ++i) {
    for (const int j : graph.neighbors[i]) edges.push_back({i, j});
  }
  return edges;
}

/// Checks what datasets say of each other.
class Check {
 public:
  Check(const Hdf5Reader& file, const FrozenProblem& problem)
      : file_(file), problem_(problem) {}

  void Edges(const std::vector<Edge>& edges) const {
    for (const auto& [i, j] : edges) {
      if (!IsNode(i) || !IsNode(j) || i == j) {
        file_.Fail("edges/nodes: " + std::to_string(i) + ", " +
                   std::to_string(j) + ": expected two of " + Nodes());
      }
    }
  }

  void Numbers() const {
    if (problem_.frame < 0 || problem_.surface < 0) {
      file_.Fail("frame or surface: expected 0 or more");
    }
    if (problem_.anneal < 1 || problem_.initial_radius < 0) {
      file_.Fail("anneal: expected 1 or more, initial_radius 0 or more");
    }
  }

  void Sizes() const {
    if (problem_.graph.size() == 0) file_.Fail("graph: expected a node");
    if (problem_.before &&
        static_cast<int>(problem_.before->size()) != problem_.graph.size()) {
      file_.Fail("before: expected a motion of each of " + Nodes());
    }
    if (problem_.start.terms.size() != problem_.energy.size()) {
      file_.Fail("terms/start_cost: expected one of each of " +
                 std::to_string(problem_.energy.size()) + " terms");
    }
    const int declared = CountUnknowns();
    if (static_cast<int>(problem_.unknowns.size()) != declared) {
      file_.Fail("unknowns/start: expected one of each of " +
                 std::to_string(declared) + " unknowns of the terms");
    }
  }

  template <typename Item>
  void Skinning(const std::string& group,
                const std::vector<Item>& items) const {
    for (const Item& item : items) {
      if (item.weight < 0) {
        file_.Fail(group + "/confidence: expected 0 or more");
      }
      const splitfusion::Skinning& skinning = item.model.skinning;
      const bool counted =
          skinning.count >= 1 && skinning.count <= kMaxSkinningNodes;
      for (int k = 0; counted && k < skinning.count; ++k) {
        if (IsNode(skinning.nodes[k]) &&
            (k == 0 || skinning.nodes[k] > skinning.nodes[k - 1])) {
          continue;
        }
        file_.Fail(group + "/nodes: expected ascending ones of " + Nodes());
      }
      if (!counted) file_.Fail(group + "/node_count: expected 1..8");
    }
  }

  void Links(const LinksInTime& links) const {
    const auto known = static_cast<int>(links.known_positions.size());
    if (known != static_cast<int>(links.known_motions.size())) {
      file_.Fail("known: expected a motion of each of " +
                 std::to_string(known) + " known nodes");
    }
    if (links.triples.size() != links.differences.size()) {
      file_.Fail("hidden_triples/factors: expected those of each of " +
                 std::to_string(links.triples.size()) + " triples");
    }
    const int nodes = problem_.graph.size() + known;
    const auto check = [&](const char* name, const auto& tuples) {
      for (const auto& tuple : tuples) {
        auto sorted = tuple;
        std::sort(sorted.begin(), sorted.end());
        const bool differ =
            std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
        if (differ && sorted.front() >= 0 && sorted.back() < nodes &&
            IsNode(sorted.front())) {
          continue;
        }
        file_.Fail(std::string(name) + ": expected different ones of " +
                   std::to_string(nodes) + " nodes, one of them sought");
      }
    };
    check("hidden_edges/nodes", links.edges);
    check("hidden_triples/nodes", links.triples);
  }

 private:
  int CountUnknowns() const {
    SurfaceProblem view = problem_.View();
    view.unknowns.clear();
    return TermUnknowns(view).size();
  }
  bool IsNode(int node) const {
    return node >= 0 && node < problem_.graph.size();
  }
  std::string Nodes() const {
    return std::to_string(problem_.graph.size()) + " nodes";
  }

  const Hdf5Reader& file_;
  const FrozenProblem& problem_;
};

void CheckContent(const Hdf5Reader& file, const FrozenProblem& problem,
                  const std::vector<Edge>& edges) {
  const Check check(file, problem);
  check.Numbers();
  check.Sizes();
  check.Edges(edges);
  check.Skinning("correspondences", problem.correspondences);
  if (problem.lost) check.Skinning("lost", *problem.lost);
  if (problem.tracks) check.Skinning("tracks", *problem.tracks);
  if (problem.links) check.Links(*problem.links);
}

/// The address of what is there.
template <typename T>
const T* AddressOf(const std::optional<T>& value) {
  return value ? &*value : nullptr;
}

/// A copy of what is there.
template <typename T>
std::optional<T> CopyOf(const T* value) {
  return value != nullptr ? std::optional<T>(*value) : std::nullopt;
}

}  // namespace

ProblemStart EvaluateStart(const SurfaceProblem& problem,
                           const DeformationGraph& graph) {
  BlockProblem blocks(problem, graph);
  blocks.Evaluate(blocks.Start(), /*with_jacobians=*/true);
  ProblemStart start;
  start.cost = blocks.Cost();
  start.terms = blocks.TermCosts();
  BorderedMatrix matrix = blocks.MakeMatrix();
  BorderedVector gradient;
  blocks.Assemble(&matrix, &gradient);
  start.gradient = std::move(gradient.nodes);
  start.by_unknowns.assign(gradient.own.begin(), gradient.own.end());
  return start;
}

SurfaceProblem FrozenProblem::View() const {
  SurfaceProblem view{energy, correspondences, camera};
  view.before = AddressOf(before);
  view.anneal = anneal;
  view.initial_radius = initial_radius;
  view.lost = AddressOf(lost);
  view.tracks = AddressOf(tracks);
  view.surface = surface;
  view.unknowns = unknowns;
  view.links = AddressOf(links);
  return view;
}

FrozenProblem CopyProblem(const SurfaceProblem& problem,
                          const DeformationGraph& graph) {
  FrozenProblem frozen;
  frozen.surface = problem.surface;
  frozen.energy = problem.energy;
  frozen.camera = problem.camera;
  frozen.anneal = problem.anneal;
  frozen.initial_radius = problem.initial_radius;
  frozen.graph = graph;
  frozen.correspondences = problem.correspondences;
  frozen.lost = CopyOf(problem.lost);
  frozen.tracks = CopyOf(problem.tracks);
  frozen.before = CopyOf(problem.before);
  frozen.links = CopyOf(problem.links);
  frozen.unknowns = TermUnknowns(problem).StartValues();
  return frozen;
}

FrozenProblem Freeze(const SurfaceProblem& problem,
                     const DeformationGraph& graph) {
  FrozenProblem frozen = CopyProblem(problem, graph);
  frozen.start = EvaluateStart(problem, graph);
  CheckComplete(frozen, frozen.start.terms);
  return frozen;
}

void WriteFrozenProblem(const std::string& path, const FrozenProblem& problem) {
  WritePathAtomically(path, [&](const std::string& temporary) {
    FrozenProblem copy = problem;  // Both directions take what may change.
    std::string format = kFormat, energy = EnergyText(problem.energy);
    std::int32_t version = kVersion;
    std::vector<Edge> edges = EdgesOf(problem.graph);
    Hdf5Writer file(temporary);
    file.Attribute("format", &format);
    file.Attribute("version", &version);
    file.Attribute("energy", &energy);
    Visit(&file, &copy, &edges);
    file.Close();
  });
}

FrozenProblem ReadFrozenProblem(const std::string& path,
                                const TermRegistry& terms) {
  Hdf5Reader file(path);
  std::string format, energy;
  std::int32_t version = 0;
  file.Attribute("format", &format);
  file.Attribute("version", &version);
  if (format != kFormat || version < kOldestVersion || version > kVersion) {
    file.Fail("is a '" + format + "' of version " + std::to_string(version) +
              ": expected a '" + kFormat + "' of version " +
              std::to_string(kOldestVersion) + " to " +
              std::to_string(kVersion));
  }
  FrozenProblem problem;
  std::vector<Edge> edges;
  file.Attribute("energy", &energy);
  Visit(&file, &problem, &edges);
  try {
    problem.energy = ParseEnergy(energy, terms);
    problem.camera.Check();
  } catch (const InputError& error) {
    file.Fail(error.what());
  }
  CheckContent(file, problem, edges);
  problem.graph.neighbors.resize(problem.graph.size());
  for (const auto& [i, j] : edges) problem.graph.neighbors[i].push_back(j);
  return problem;
}

}  // namespace splitfusion
