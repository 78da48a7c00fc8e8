#include "splitfusion/lib/evaluation/trajectory_error.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <set>
#include <tuple>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/pi.h"

namespace splitfusion {
namespace {

constexpr int kMinMatches = 3;

/// Poses of the pairs, in the same order.
struct MatchedPoses {
  std::vector<Rigid3d> estimate;
  std::vector<Rigid3d> truth;

  int size() const { return static_cast<int>(truth.size()); }
};

void SortByTime(Trajectory* trajectory) {
  std::stable_sort(trajectory->begin(), trajectory->end(),
                   [](const TimedPose& a, const TimedPose& b) {
                     return a.timestamp < b.timestamp;
                   });
}

/// Index of the pose nearest in time; the later one of two equally near.
int NearestInTime(const Trajectory& trajectory, double timestamp) {
  const auto after = std::lower_bound(
      trajectory.begin(), trajectory.end(), timestamp,
      [](const TimedPose& pose, double t) { return pose.timestamp < t; });
  const int index = static_cast<int>(after - trajectory.begin());
  if (index == 0) return 0;
  if (index == static_cast<int>(trajectory.size())) return index - 1;
  const double before = timestamp - trajectory[index - 1].timestamp;
  return before < trajectory[index].timestamp - timestamp ? index - 1 : index;
}

MatchedPoses Gather(const Trajectory& estimate, const Trajectory& truth,
                    const std::vector<std::pair<int, int>>& pairs) {
  MatchedPoses poses;
  for (const auto& [i, j] : pairs) {
    poses.estimate.push_back(estimate[i].world_from_camera);
    poses.truth.push_back(truth[j].world_from_camera);
  }
  return poses;
}

Eigen::Matrix3Xd Positions(const std::vector<Rigid3d>& poses) {
  Eigen::Matrix3Xd positions(3, poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    positions.col(static_cast<Eigen::Index>(i)) = poses[i].translation();
  }
  return positions;
}

/// Chordal mean of R_truth R_estimate^T over all pairs; translation by the
/// means of the positions.
Rigid3d AlignPoses(const MatchedPoses& poses) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int i = 0; i < poses.size(); ++i) {
    sum += poses.truth[i].linear() * poses.estimate[i].linear().transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
      sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d signs = Eigen::Matrix3d::Identity();
  signs(2, 2) = (svd.matrixU() * svd.matrixV()).determinant() < 0 ? -1 : 1;
  Rigid3d alignment = Rigid3d::Identity();
  alignment.linear() = svd.matrixU() * signs * svd.matrixV().transpose();
  alignment.translation() =
      Positions(poses.truth).rowwise().mean() -
      alignment.linear() * Positions(poses.estimate).rowwise().mean();
  return alignment;
}

double PathLength(const std::vector<Rigid3d>& poses) {
  double length = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    length += (poses[i].translation() - poses[i - 1].translation()).norm();
  }
  return length;
}

ErrorStatistics AbsoluteError(const MatchedPoses& poses,
                              const Rigid3d& truth_from_estimate) {
  std::vector<double> errors;
  for (int i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d aligned =
        truth_from_estimate * poses.estimate[i].translation();
    errors.push_back((aligned - poses.truth[i].translation()).norm());
  }
  return Summarize(errors);
}

RelativePoseError RelativeError(const MatchedPoses& poses, int step) {
  std::vector<double> translations;
  std::vector<double> degrees;
  for (int i = 0; i + step < poses.size(); ++i) {
    const Rigid3d truth = poses.truth[i].inverse() * poses.truth[i + step];
    const Rigid3d estimate =
        poses.estimate[i].inverse() * poses.estimate[i + step];
    const Rigid3d error = truth.inverse() * estimate;
    translations.push_back(error.translation().norm());
    degrees.push_back(RotationAngle(error.linear()) * 180 / kPi<double>);
  }
  return {step, Summarize(translations), Summarize(degrees)};
}

void CheckMatches(const Trajectory& estimate, const Trajectory& truth,
                  std::size_t matches, double tolerance) {
  if (matches >= kMinMatches) return;
  throw InputError(cv::format(
      "%zu of %zu estimated poses match one of the %zu true poses "
      "within %g s: expected at least %d",
      matches, estimate.size(), truth.size(), tolerance, kMinMatches));
}

}  // namespace

void TrajectoryErrorOptions::Check() const {
  CheckOption(max_time_difference > 0, "max_time_difference",
              max_time_difference, "seconds > 0");
  for (const int step : relative_frames) {
    CheckOption(step >= 1, "relative_frames", step, ">= 1");
  }
}

std::vector<std::pair<int, int>> MatchPoses(const Trajectory& estimate,
                                            const Trajectory& truth,
                                            double max_time_difference) {
  if (truth.empty()) return {};
  std::vector<std::tuple<double, int, int>> candidates;
  for (int i = 0; i < static_cast<int>(estimate.size()); ++i) {
    const int j = NearestInTime(truth, estimate[i].timestamp);
    const double difference =
        std::abs(truth[j].timestamp - estimate[i].timestamp);
    if (difference <= max_time_difference) {
      candidates.emplace_back(difference, i, j);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::set<int> used;
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [difference, i, j] : candidates) {
    if (used.insert(j).second) pairs.emplace_back(i, j);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

TrajectoryError CompareTrajectories(Trajectory estimate, Trajectory truth,
                                    const TrajectoryErrorOptions& options) {
  options.Check();
  SortByTime(&estimate);
  SortByTime(&truth);
  const auto pairs = MatchPoses(estimate, truth, options.max_time_difference);
  CheckMatches(estimate, truth, pairs.size(), options.max_time_difference);
  const MatchedPoses poses = Gather(estimate, truth, pairs);
  TrajectoryError result;
  result.matched = poses.size();
  result.estimated_poses = static_cast<int>(estimate.size());
  result.true_poses = static_cast<int>(truth.size());
  result.path_length = PathLength(poses.truth);
  result.truth_from_estimate.matrix() =
      Eigen::umeyama(Positions(poses.estimate), Positions(poses.truth),
                     /*with_scaling=*/false);
  result.truth_from_estimate_by_poses = AlignPoses(poses);
  result.absolute = AbsoluteError(poses, result.truth_from_estimate);
  for (const int step : options.relative_frames) {
    if (poses.size() > step) {
      result.relative.push_back(RelativeError(poses, step));
    }
  }
  return result;
}

}  // namespace splitfusion
