#include "splitfusion/pipelines/part_start.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/trial_surface.h"
#include "splitfusion/lib/geometry/nearest_point.h"
#include "splitfusion/lib/tracking/agreement.h"

namespace splitfusion {
namespace {

/// Labels of what no part carries, and of what no match is near to; those of
/// parts are their indices.
constexpr int kStays = -1, kUnknown = -2;  // Layout.

/// Every n-th pixel of the samples that are matched in the solve ...
constexpr int kStride = 4;  // Speed: nodes are many pixels apart.
/// ... and steps of the solve that bends the surface where parts meet.
constexpr int kSteps = 5;  // Speed: it changes by nothing after four.

std::vector<Eigen::Vector3f> Warped(const std::vector<ModelSample>& samples,
                                    const DeformationGraph& graph) {
  const WarpField warp(graph);
  std::vector<Eigen::Vector3f> points;
  points.reserve(samples.size());
  for (const ModelSample& sample : samples) {
    points.push_back(warp.WarpPoint(sample.skinning, sample.point));
  }
  return points;
}

/// Where points of the surface were that were matched, and what carries them.
struct LabeledPoints {
  std::vector<Eigen::Vector3f> from;
  std::vector<int> labels;

  void Add(const Eigen::Vector3f& point, int label) {
    from.push_back(point);
    labels.push_back(label);
  }
};

/// Motions of points on the model that moved otherwise than the surface;
/// those that moved as it does are added to `stay`. `before`, `now`: samples
/// where they were and where the surface has moved them.
std::vector<PointMotion> OwnMotions(const std::vector<PointMotion>& motions,
                                    const std::vector<Eigen::Vector3f>& before,
                                    const std::vector<Eigen::Vector3f>& now,
                                    const DepthNoise& noise,
                                    LabeledPoints* stay) {
  std::vector<PointMotion> own;
  const NearestPoint places(before);
  int nearest = -1;
  for (const PointMotion& motion : motions) {
    float distance = 0;
    nearest = places.Find(motion.from, nearest, &distance);
    if (distance > kAgreeingDistance) continue;
    const Eigen::Vector3f expected =
        motion.from + now[nearest] - before[nearest];
    if ((expected - motion.to).norm() >
        kAgreeingDistance + 2 * noise.Sigma(motion.to.z())) {
      own.push_back(motion);
    } else {
      stay->Add(motion.from, kStays);
    }
  }
  return own;
}

/// The label of the nearest match of every sample.
std::vector<int> SampleLabels(const std::vector<Eigen::Vector3f>& before,
                              const LabeledPoints& matches) {
  std::vector<int> labels(before.size(), kUnknown);
  const NearestPoint places(matches.from);
  int nearest = -1;
  for (std::size_t i = 0; i < before.size(); ++i) {
    float distance = 0;
    nearest = places.Find(before[i], nearest, &distance);
    if (distance <= 2 * kAgreeingDistance) labels[i] = matches.labels[nearest];
  }
  return labels;
}

/// Labels of all nodes: that of most of what they carry; of those that carry
/// nothing which has one, of the nearest node along the edges, two spacings
/// away at most.
std::vector<int> NodeLabels(const std::vector<ModelSample>& samples,
                            const std::vector<int>& labels, std::size_t parts,
                            const DeformationGraph& graph) {
  std::vector<std::vector<float>> votes(graph.size(),
                                        std::vector<float>(parts + 1, 0));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (labels[i] == kUnknown) continue;
    const Skinning& skinning = samples[i].skinning;
    for (int k = 0; k < skinning.count; ++k) {
      votes[skinning.nodes[k]][labels[i] + 1] += skinning.weights[k];
    }
  }
  using Entry = std::tuple<double, int, int>;  // Way, node, label.
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (int node = 0; node < graph.size(); ++node) {
    const auto best = std::max_element(votes[node].begin(), votes[node].end());
    if (*best > 0) {
      open.push({0, node, static_cast<int>(best - votes[node].begin()) - 1});
    }
  }
  std::vector<int> result(graph.size(), kUnknown);
  while (!open.empty()) {
    const auto [way, node, label] = open.top();
    open.pop();
    if (result[node] != kUnknown) continue;
    result[node] = label;
    for (const int next : graph.neighbors[node]) {
      const double there =
          way + (graph.positions[next] - graph.positions[node]).norm();
      if (result[next] == kUnknown && there <= 2 * graph.node_spacing) {
        open.push({there, next, label});
      }
    }
  }
  return result;
}

NodeMotion Carried(const Rigid3d& motion, const Eigen::Vector3d& g,
                   const NodeMotion& node) {
  return {motion.linear() * node.rotation, motion * (g + node.translation) - g};
}

Correspondence PairOf(const ModelSample& sample, const Eigen::Vector3f& target,
                      double weight) {
  Correspondence pair;
  pair.model = sample;
  pair.warped_normal = pair.target_normal = sample.normal;
  pair.target = target;
  pair.weight = static_cast<float>(weight);
  return pair;
}

/// A node as a point that it alone carries.
ModelSample SampleAt(int node, const DeformationGraph& graph) {
  ModelSample sample;
  sample.point = graph.positions[node].cast<float>();
  sample.normal = Eigen::Vector3f::UnitZ();
  sample.skinning.count = 1;
  sample.skinning.nodes[0] = node;
  sample.skinning.weights[0] = 1;
  return sample;
}

}  // namespace

void PartStartOptions::List(OptionList* list) {
  list->Part("", &parts);
  list->Number("part_gain", &gain, Range::Share(), "",
               "A part starts where its points were matched if the misfit of "
               "what it carries is there below this fraction of that without.");
  list->Number("part_hold", &hold, Range::Above(0), "",
               "Weight with which what no match is near to stays while parts "
               "are moved; matched points have 1.");
}

PartStarter::PartStarter(PartStartOptions options, const Solver& solver)
    : options_(options),
      solver_(solver),
      energy_(ParseEnergy("point_to_point arap", BuiltinTerms())) {}

PartStart PartStarter::Start(const Surface& surface,
                             DeformationGraph* graph) const {
  const std::vector<ModelSample>& samples = surface.samples;
  if (samples.empty() || surface.motions.empty()) return {};
  const std::vector<Eigen::Vector3f> before = Warped(samples, surface.stayed);
  const std::vector<Eigen::Vector3f> now = Warped(samples, *graph);
  LabeledPoints matches;
  const std::vector<PointMotion> own =
      OwnMotions(surface.motions, before, now, surface.camera.noise, &matches);
  const std::vector<RigidPart> parts =
      FindRigidParts(own, surface.camera.noise, options_.parts);
  if (parts.empty()) return {};
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const int i : parts[p].points) {
      matches.Add(own[i].from, static_cast<int>(p));
    }
  }
  std::vector<int> labels = SampleLabels(before, matches);
  PartStart start;
  start.parts = KeepWhatFits(surface, parts, *graph, &labels);
  if (start.parts == 0) return {};
  const std::vector<int> nodes =
      NodeLabels(samples, labels, parts.size(), *graph);
  for (const int label : nodes) start.carried.push_back(label >= 0);
  DeformationGraph started = *graph;
  std::vector<Correspondence> pairs;
  for (int node = 0; node < graph->size(); ++node) {
    if (nodes[node] >= 0) {
      started.motions[node] =
          Carried(parts[nodes[node]].motion, graph->positions[node],
                  surface.stayed.motions[node]);
    } else if (nodes[node] == kUnknown) {
      const Eigen::Vector3d place =
          graph->positions[node] + graph->motions[node].translation;
      pairs.push_back(
          PairOf(SampleAt(node, *graph), place.cast<float>(), options_.hold));
    }
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].u % kStride != 0 || samples[i].v % kStride != 0) continue;
    const Eigen::Vector3f target =
        labels[i] < 0 ? now[i]
                      : parts[labels[i]].motion.cast<float>() * before[i];
    pairs.push_back(
        PairOf(samples[i], target, labels[i] == kUnknown ? options_.hold : 1));
  }
  SurfaceProblem problem{energy_, pairs, surface.camera};
  problem.surface = kTrialSurface;
  for (int step = 0; step < kSteps; ++step) {
    solver_.Minimize(problem, &started);
  }
  if (surface.misfit(samples, started) >= surface.misfit(samples, *graph)) {
    return {};
  }
  *graph = std::move(started);
  return start;
}

int PartStarter::KeepWhatFits(const Surface& surface,
                              const std::vector<RigidPart>& parts,
                              const DeformationGraph& graph,
                              std::vector<int>* labels) const {
  int kept = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const int label = static_cast<int>(p);
    std::vector<ModelSample> carried;
    for (std::size_t i = 0; i < labels->size(); ++i) {
      if ((*labels)[i] == label) carried.push_back(surface.samples[i]);
    }
    DeformationGraph there = surface.stayed;
    ApplyRigidMotion(parts[p].motion, &there);
    if (!carried.empty() &&
        surface.misfit(carried, there) <
            options_.gain * surface.misfit(carried, graph)) {
      ++kept;
    } else {
      std::replace(labels->begin(), labels->end(), label, kStays);
    }
  }
  return kept;
}

}  // namespace splitfusion
