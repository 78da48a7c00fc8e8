#include "splitfusion/lib/model/hidden_deviations.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "splitfusion/lib/model/hidden_window.h"
#include "splitfusion/lib/model/part_motions.h"

namespace splitfusion {
namespace {

/// Squared ways, by frame, then node, from one solution to another.
std::vector<double> SquaredWays(const PartMotions& from,
                                const PartMotions& to) {
  std::vector<double> ways;
  for (int f = 0; f < from.frames(); ++f) {
    for (int i = 0; i < from.nodes(); ++i) {
      ways.push_back(
          (to.states[f][i].place - from.states[f][i].place).squaredNorm());
    }
  }
  return ways;
}

/// Mean squares, by frame, then node, by which solutions under noise differ
/// from the one without.
std::vector<double> MeanSquaredWays(const HiddenMotionOptions& options,
                                    const PartMotions& start) {
  constexpr int kBlock = 32;  // Speed. Samples that are kept at a time.
  const ResidualNoise noise = NoiseOfSeen(options.smoothness, start);
  PartMotions without = start;
  RefinePart(options, {}, &without);
  std::vector<double> mean(static_cast<std::size_t>(start.frames()) *
                           start.nodes());
  std::array<std::vector<double>, kBlock> ways;
  for (int begin = 0; begin < options.samples; begin += kBlock) {
    const int count = std::min(kBlock, options.samples - begin);
    tbb::parallel_for(0, count, [&](int k) {
      PartMotions with = start;
      ResidualNoise own = noise;
      own.seed = static_cast<std::uint64_t>(begin + k);
      RefinePart(options, own, &with);
      ways[k] = SquaredWays(without, with);
    });
    for (std::size_t i = 0; i < mean.size(); ++i) {
      for (int k = 0; k < count; ++k) mean[i] += ways[k][i] / options.samples;
    }
  }
  return mean;
}

void AddDeviations(const PartMotions& motions,
                   const std::vector<double>& squares,
                   std::vector<HiddenDeviation>* deviations) {
  constexpr double kAxes = 3;  // Maths.
  for (int f = 0; f < motions.frames(); ++f) {
    for (int i = 0; i < motions.nodes(); ++i) {
      if (motions.hidden[f][i] == 0) continue;
      const std::size_t at = static_cast<std::size_t>(f) * motions.nodes() + i;
      deviations->push_back({motions.first_node + i, motions.indices[f],
                             std::sqrt(squares[at] / kAxes)});
    }
  }
}

}  // namespace

std::vector<HiddenDeviation> HiddenDeviations(
    const std::map<int, Rigid3d>& world_from_camera,
    const HiddenMotionOptions& options, const SurfaceModel& model) {
  std::vector<HiddenDeviation> deviations;
  if (options.samples == 0) return deviations;
  const std::size_t parts = std::max<std::size_t>(1, model.graph.parts.size());
  const std::vector<Eigen::Vector3d> centers = CentersOf(model);
  std::vector<char> refuted = WhichWereRefuted(model.graph);
  refuted.resize(parts, false);
  for (std::size_t part = 0; part < parts; ++part) {
    if (refuted[part] != 0) continue;
    const PartFrames frames(part, centers, world_from_camera, model);
    PartMotions motions = frames.motions();
    if (!motions.HasHidden(0, motions.frames())) continue;
    frames.Load(0, motions.frames(), &motions);
    AddDeviations(motions, MeanSquaredWays(options, motions), &deviations);
  }
  return deviations;
}

}  // namespace splitfusion
