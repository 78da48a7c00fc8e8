#include "splitfusion/lib/visibility/known_nodes.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

namespace splitfusion {
namespace {

/// A walk ends anywhere with this probability a step, so that one that cannot
/// come to what is seen is long and not infinite.
constexpr double kLeak = 1e-7;

/// Before any frame.
constexpr int kNever = -1000000000;

/// Last frame up to `frame` in which a node was seen, or kNever.
int LastSeen(const std::vector<FrameRun>& sightings, int frame) {
  int last = kNever;
  for (const FrameRun& run : sightings) {
    if (run.first <= frame) last = std::min(run.last, frame);
  }
  return last;
}

/// Which nodes had been seen in the kLatelyFrames frames that end with the last
/// one, up to `frame`, that showed anything.
std::vector<char> SeenLately(const DeformationGraph& graph, int frame) {
  std::vector<int> last;
  for (const std::vector<FrameRun>& sightings : graph.sightings) {
    last.push_back(LastSeen(sightings, frame));
  }
  const int now = *std::max_element(last.begin(), last.end());
  std::vector<char> lately;
  for (const int seen : last) {
    lately.push_back(seen > now - kLatelyFrames);
  }
  return lately;
}

/// Both directions of all edges between nodes of a mask, each once.
std::vector<std::vector<int>> EdgesAmong(const std::vector<char>& mask,
                                         const DeformationGraph& graph) {
  std::vector<std::vector<int>> edges(graph.size());
  for (int i = 0; i < graph.size(); ++i) {
    for (const int j : graph.neighbors[i]) {
      if (!mask[i] || !mask[j]) continue;
      edges[i].push_back(j);
      edges[j].push_back(i);
    }
  }
  for (std::vector<int>& ends : edges) {
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  }
  return edges;
}

/// Mean number of steps from every node of `walkers` to one that is none.
Eigen::VectorXd StepsOut(const std::vector<int>& walkers,
                         const std::vector<std::vector<int>>& edges) {
  const int count = static_cast<int>(walkers.size());
  std::vector<int> rows(edges.size(), -1);
  for (int row = 0; row < count; ++row) rows[walkers[row]] = row;
  // deg(i) n_i - sum over walkers j beside i of n_j = deg(i)
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd degrees(count);
  for (int row = 0; row < count; ++row) {
    const std::vector<int>& ends = edges[walkers[row]];
    degrees[row] = std::max<double>(1, ends.size());
    entries.emplace_back(row, row, ends.size() + kLeak * degrees[row]);
    for (const int j : ends) {
      if (rows[j] >= 0) entries.emplace_back(row, rows[j], -1);
    }
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(
      degrees);
}

}  // namespace

std::vector<char> SeenNodes(const DeformationGraph& graph, int frame) {
  std::vector<char> seen(graph.size(), true);
  if (graph.first_seen.size() < seen.size()) return seen;
  for (int i = 0; i < graph.size(); ++i) {
    seen[i] = graph.first_seen[i] <= frame;
  }
  return seen;
}

std::vector<char> KnownNodes(const DeformationGraph& graph, int frame) {
  std::vector<char> known = SeenNodes(graph, frame);
  if (graph.first_seen.size() < known.size()) return known;
  if (graph.sightings.size() < known.size()) return known;
  const std::vector<char> lately = SeenLately(graph, frame);
  std::vector<int> hidden;
  for (int i = 0; i < graph.size(); ++i) {
    if (known[i] && !lately[i]) hidden.push_back(i);
  }
  if (hidden.empty()) return known;
  const Eigen::VectorXd steps = StepsOut(hidden, EdgesAmong(known, graph));
  for (std::size_t k = 0; k < hidden.size(); ++k) {
    known[hidden[k]] = graph.node_spacing * std::sqrt(steps[k]) <= kFirmWalk;
  }
  return known;
}

}  // namespace splitfusion
