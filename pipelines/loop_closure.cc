#include "splitfusion/pipelines/loop_closure.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "splitfusion/lib/tracking/agreement.h"
#include "splitfusion/pipelines/pose_graph.h"

namespace splitfusion {
namespace {

/// Pairs of key frames to be compared: neighbours, and those that look most
/// alike of all others, the earlier one first.
std::vector<std::pair<int, int>> PairsToCompare(
    const std::vector<PathFrame>& path, int candidates) {
  std::vector<std::pair<int, int>> pairs;
  const int size = static_cast<int>(path.size());
  for (int i = 1; i < size; ++i) {
    pairs.emplace_back(i - 1, i);
    std::vector<std::pair<double, int>> alike;
    for (int j = 0; j < i - 1; ++j) {
      alike.emplace_back(-path[i].view.thumbnail.dot(path[j].view.thumbnail),
                         j);
    }
    std::sort(alike.begin(), alike.end());
    for (int k = 0; k < std::min<int>(candidates, alike.size()); ++k) {
      pairs.emplace_back(alike[k].second, i);
    }
  }
  return pairs;
}

/// Motions between key frames as their landmarks say.
std::vector<PoseEdge> LandmarkEdges(
    const std::vector<PathFrame>& path,
    const std::vector<std::pair<int, int>>& pairs, const DepthNoise& noise,
    const KeyFrameOptions& options) {
  std::vector<std::optional<LandmarkMotion>> motions(pairs.size());
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t i) {
    const auto [from, to] = pairs[i];
    motions[i] =
        FindLandmarkMotion(path[from].view.landmarks, path[to].view.landmarks,
                           noise, options.ratio);
  });
  std::vector<PoseEdge> edges;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!motions[i] || motions[i]->points < options.agreeing) continue;
    edges.push_back({pairs[i].first, pairs[i].second, motions[i]->motion,
                     motions[i]->where, /*may_be_wrong=*/true});
  }
  return edges;
}

/// Motions between neighbours as they were tracked.
std::vector<PoseEdge> TrackedEdges(const std::vector<PathFrame>& path,
                                   const std::vector<Rigid3d>& poses) {
  std::vector<PoseEdge> edges;
  for (int i = 1; i < static_cast<int>(path.size()); ++i) {
    if (!path[i].goes_on) continue;
    edges.push_back(
        {i - 1, i, poses[i] * poses[i - 1].inverse(), path[i - 1].points});
  }
  return edges;
}

/// Root mean square of contradictions.
double RmsContradiction(const std::vector<Rigid3d>& poses,
                        const std::vector<PoseEdge>& edges) {
  double sum = 0;
  for (const PoseEdge& edge : edges) {
    const double off = Contradiction(poses, edge);
    sum += off * off;
  }
  return edges.empty() ? 0 : std::sqrt(sum / static_cast<double>(edges.size()));
}

/// A part of the way from one correction to the next.
Rigid3d PartOfCorrection(const Rigid3d& from, const Rigid3d& to, double share) {
  Rigid3d part = Rigid3d::Identity();
  part.linear() = Eigen::Quaterniond(from.linear())
                      .slerp(share, Eigen::Quaterniond(to.linear()))
                      .toRotationMatrix();
  part.translation() =
      (1 - share) * from.translation() + share * to.translation();
  return part;
}

/// Corrects all poses, world from camera. `corrections`: of camera frames, by
/// frame, of some.
void CorrectBetween(const std::map<int, Rigid3d>& corrections,
                    std::map<int, Rigid3d>* world_from_camera) {
  for (auto& [frame, pose] : *world_from_camera) {
    auto next = corrections.lower_bound(frame);
    if (next == corrections.end()) --next;
    const auto last = next == corrections.begin() ? next : std::prev(next);
    const double span = next->first - last->first;
    const double share =
        span > 0 && frame < next->first ? (frame - last->first) / span : 1;
    pose = pose * PartOfCorrection(last->second, next->second, share).inverse();
  }
}

/// Takes poses of key frames, camera from world, for those that they had, and
/// reports on it.
void Correct(const std::vector<PathFrame>& path,
             const std::vector<Rigid3d>& before,
             const std::vector<Rigid3d>& after, LoopClosure* closure) {
  LoopReport& report = closure->report;
  std::map<int, Rigid3d> corrections;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Rigid3d change = after[i] * before[i].inverse();
    const Rigid3d from = before[i].inverse(), to = after[i].inverse();
    const TypicalPoints& points = path[i].points;
    report.largest_change =
        std::max(report.largest_change, (change * points - points).norm() / 2);
    report.largest_shift = std::max(
        report.largest_shift, (to.translation() - from.translation()).norm());
    report.largest_turn =
        std::max(report.largest_turn, RotationAngle(change.linear()));
    corrections[path[i].frame] = change;
  }
  CorrectBetween(corrections, &closure->world_from_camera);
}

}  // namespace

LoopClosure CloseLoops(const std::vector<PathFrame>& path,
                       const std::map<int, Rigid3d>& tracked,
                       const DepthNoise& noise, const KeyFrameOptions& options,
                       double reach) {
  LoopClosure closure;
  LoopReport& report = closure.report;
  closure.world_from_camera = tracked;
  if (path.empty()) return closure;
  std::vector<Rigid3d> before;
  for (const PathFrame& frame : path) before.emplace_back(frame.view.pose);
  const auto pairs = PairsToCompare(path, options.candidates);
  const std::vector<PoseEdge> found =
      LandmarkEdges(path, pairs, noise, options);
  std::vector<PoseEdge> edges = TrackedEdges(path, before);
  edges.insert(edges.end(), found.begin(), found.end());
  // Drift may be as much from one key frame to the next.
  const double distance = 3 * kAgreeingDistance;
  const std::vector<Rigid3d> after = SolvePoseGraph(before, edges, distance);
  std::vector<PoseEdge> kept;
  for (const PoseEdge& edge : found) {
    if (Contradiction(after, edge) > distance) continue;
    kept.push_back(edge);
    report.largest_drift =
        std::max(report.largest_drift, Contradiction(before, edge));
  }
  report.key_frames = static_cast<int>(path.size());
  report.compared = static_cast<int>(pairs.size());
  report.found = static_cast<int>(found.size());
  report.kept = static_cast<int>(kept.size());
  report.misfit_before = RmsContradiction(before, kept);
  // What correspondences reach they have closed; the rest is what landmarks are
  // uncertain by.
  const bool corrects = report.largest_drift > reach;
  report.misfit_after = RmsContradiction(corrects ? after : before, kept);
  if (corrects) Correct(path, before, after, &closure);
  return closure;
}

}  // namespace splitfusion
