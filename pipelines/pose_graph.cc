#include "splitfusion/pipelines/pose_graph.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "splitfusion/cost_functions/relative_pose.h"
#include "splitfusion/lib/energy/twist.h"

namespace splitfusion {
namespace {

using PoseTwist = std::array<double, kTwistSize>;

/// X of RelativePose.
Rigid3d MotionOfTwist(const PoseTwist& twist) {
  Rigid3d motion = Rigid3d::Identity();
  motion.linear() = ExpSo3({twist[0], twist[1], twist[2]});
  motion.translation() << twist[3], twist[4], twist[5];
  return motion;
}

/// One minimisation; Tukey's loss of width `reach`, metres.
void MinimizeOnce(const std::vector<PoseEdge>& edges, double distance,
                  double reach, std::vector<Rigid3d>* poses) {
  std::vector<PoseTwist> twists(poses->size(), PoseTwist{});
  ceres::Problem problem;
  for (PoseTwist& twist : twists) {
    problem.AddParameterBlock(twist.data(), kTwistSize);
  }
  problem.SetParameterBlockConstant(twists.front().data());
  for (const PoseEdge& edge : edges) {
    using Cost =
        ceres::AutoDiffCostFunction<RelativePose, RelativePose::kResiduals,
                                    kTwistSize, kTwistSize>;
    const Rigid3d before = (*poses)[edge.to] * (*poses)[edge.from].inverse();
    ceres::LossFunction* loss = new ceres::HuberLoss(distance);
    if (edge.may_be_wrong) {
      delete loss;
      loss = new ceres::TukeyLoss(reach);
    }
    problem.AddResidualBlock(
        new Cost(new RelativePose(before, edge.motion, edge.points)), loss,
        twists[edge.from].data(), twists[edge.to].data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 100;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    throw std::runtime_error("pose graph: " + summary.message);
  }
  for (std::size_t i = 0; i < twists.size(); ++i) {
    Rigid3d& pose = (*poses)[i];
    pose = MotionOfTwist(twists[i]) * pose;
    pose.linear() = Orthonormalized(pose.linear());
  }
}

}  // namespace

double Contradiction(const std::vector<Rigid3d>& poses, const PoseEdge& edge) {
  const Rigid3d between = poses[edge.to] * poses[edge.from].inverse();
  const TypicalPoints off = between * edge.points - edge.motion * edge.points;
  return off.norm() / 2;
}

std::vector<Rigid3d> SolvePoseGraph(std::vector<Rigid3d> poses,
                                    const std::vector<PoseEdge>& edges,
                                    double distance) {
  double reach = distance;
  for (const PoseEdge& edge : edges) {
    reach = std::max(reach, 2 * Contradiction(poses, edge));
  }
  MinimizeOnce(edges, distance, reach, &poses);
  while (reach > distance) {
    reach = std::max(distance, reach / 2);
    MinimizeOnce(edges, distance, reach, &poses);
  }
  return poses;
}

}  // namespace splitfusion
