#include "splitfusion/pipelines/loop_closure.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
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

/// The motion between none and all of `all`.
Rigid3d PartOfCorrection(const Rigid3d& none, const Rigid3d& all,
                         double share) {
  Rigid3d between = Rigid3d::Identity();
  between.linear() = Eigen::Quaterniond(none.linear())
                         .slerp(share, Eigen::Quaterniond(all.linear()))
                         .toRotationMatrix();
  between.translation() =
      (1 - share) * none.translation() + share * all.translation();
  return between;
}

}  // namespace

LoopClosure CloseLoops(const std::vector<PathFrame>& path,
                       const std::map<int, Rigid3d>& tracked,
                       const DepthNoise& noise,
                       const KeyFrameOptions& options) {
  LoopClosure closure;
  LoopReport& report = closure.report;
  closure.world_from_camera = tracked;
  report.key_frames = static_cast<int>(path.size());
  if (path.empty()) return closure;
  std::vector<Rigid3d> before;
  for (const PathFrame& frame : path) before.emplace_back(frame.view.pose);
  const auto pairs = PairsToCompare(path, options.candidates);
  const std::vector<PoseEdge> found =
      LandmarkEdges(path, pairs, noise, options);
  std::vector<PoseEdge> edges = found;
  for (int i = 1; i < static_cast<int>(path.size()); ++i) {
    if (!path[i].goes_on) continue;
    edges.push_back(
        {i - 1, i, before[i] * before[i - 1].inverse(), path[i - 1].points});
  }
  const double distance =
      (getenv("SFD") ? atof(getenv("SFD")) : 3) * kAgreeingDistance;
  const std::vector<Rigid3d> after = SolvePoseGraph(before, edges, distance);
  std::vector<PoseEdge> kept;
  for (const PoseEdge& edge : found) {
    if (Contradiction(after, edge) > distance) continue;
    kept.push_back(edge);
    report.largest_drift =
        std::max(report.largest_drift, Contradiction(before, edge));
  }
  if (getenv("SFDUMP")) {
    FILE* f = fopen(getenv("SFDUMP"), "w");
    const auto mat = [&](const auto& m) {
      for (int r = 0; r < m.rows(); ++r)
        for (int c = 0; c < m.cols(); ++c) fprintf(f, " %.9g", m(r, c));
    };
    for (size_t i = 0; i < path.size(); ++i) {
      fprintf(f, "node %d %d", path[i].frame, path[i].goes_on);
      mat(before[i].matrix()), mat(path[i].points);
      fprintf(f, "\n");
    }
    for (const PoseEdge& e : edges) {
      fprintf(f, "edge %d %d %d", e.from, e.to, e.may_be_wrong);
      mat(e.motion.matrix()), mat(e.points);
      fprintf(f, "\n");
    }
    for (const auto& [frame, pose] : tracked) {
      fprintf(f, "pose %d", frame);
      mat(pose.matrix());
      fprintf(f, "\n");
    }
    fclose(f);
  }
  report.compared = static_cast<int>(pairs.size());
  report.found = static_cast<int>(found.size());
  report.kept = static_cast<int>(kept.size());
  report.misfit_before = RmsContradiction(before, kept);
  report.misfit_after = RmsContradiction(after, kept);
  // Less is what landmarks are uncertain by, and what correspondences reach
  // from old places: there the camera has come back already.
  if (report.largest_drift <= distance) return closure;
  std::map<int, Rigid3d> corrections;  // Of camera frames.
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Rigid3d change = after[i] * before[i].inverse();
    const Rigid3d moved = after[i].inverse() * before[i];
    const TypicalPoints& points = path[i].points;
    corrections[path[i].frame] = change;
    report.largest_change =
        std::max(report.largest_change, (change * points - points).norm() / 2);
    report.largest_shift = std::max(
        report.largest_shift,
        (after[i].inverse().translation() - before[i].inverse().translation())
            .norm());
    report.largest_turn =
        std::max(report.largest_turn, RotationAngle(moved.linear()));
  }
  for (auto& [frame, pose] : closure.world_from_camera) {
    auto next = corrections.lower_bound(frame);
    if (next == corrections.end()) --next;
    const auto last = next == corrections.begin() ? next : std::prev(next);
    const double span = next->first - last->first;
    const double share =
        span > 0 && frame < next->first ? (frame - last->first) / span : 1;
    const Rigid3d change = PartOfCorrection(last->second, next->second, share);
    pose = pose * change.inverse();
  }
  return closure;
}

}  // namespace splitfusion
