#include "splitfusion/lib/tracking/rigid_parts.h"

#include <pcl/console/print.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_registration.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace splitfusion {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Registration = pcl::SampleConsensusModelRegistration<pcl::PointXYZ>;

/// Balls in which parts are drawn, at most.
constexpr int kMaxSeeds = 32;  // Speed: a person has fewer moving parts.
/// Draws in one ball, at most; consensus ends before if it is sure.
constexpr int kDraws = 100;  // Speed: of three, 99 % with a third of outliers.

/// Points in turn that are farthest from those before, until all are within
/// `distance` of one.
std::vector<int> SpreadSeeds(const std::vector<PointMotion>& motions,
                             double distance) {
  std::vector<float> nearest(motions.size(),
                             std::numeric_limits<float>::infinity());
  std::vector<int> seeds;
  int next = 0;
  while (static_cast<int>(seeds.size()) < kMaxSeeds) {
    seeds.push_back(next);
    const Eigen::Vector3f& seed = motions[next].from;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      nearest[i] = std::min(nearest[i], (motions[i].from - seed).norm());
    }
    next = static_cast<int>(std::max_element(nearest.begin(), nearest.end()) -
                            nearest.begin());
    if (nearest[next] <= distance) break;
  }
  return seeds;
}

/// Consensus of the motions in the ball about a seed; its motion.
std::optional<Rigid3d> MotionAbout(const std::vector<PointMotion>& motions,
                                   const Eigen::Vector3f& seed, double inlier,
                                   const RigidPartOptions& options) {
  // That there is no consensus is an answer, and no error to be printed.
  static const bool silent = [] {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
    return true;
  }();
  static_cast<void>(silent);
  const auto from = pcl::make_shared<Cloud>(), to = pcl::make_shared<Cloud>();
  for (const PointMotion& motion : motions) {
    if ((motion.from - seed).norm() > options.radius) continue;
    from->push_back({motion.from.x(), motion.from.y(), motion.from.z()});
    to->push_back({motion.to.x(), motion.to.y(), motion.to.z()});
  }
  if (static_cast<int>(from->size()) < options.min_points) return {};
  const auto model = pcl::make_shared<Registration>(from);
  model->setInputTarget(to);
  pcl::RandomSampleConsensus<pcl::PointXYZ> consensus(model, inlier);
  consensus.setMaxIterations(kDraws);
  if (!consensus.computeModel()) return {};
  Eigen::VectorXf coefficients;
  consensus.getModelCoefficients(coefficients);
  Rigid3d motion;
  for (int row = 0; row < 3; ++row) {
    motion.matrix().row(row) =
        coefficients.segment<4>(4 * row).transpose().cast<double>();
  }
  motion.makeAffine();
  return motion;
}

/// The points of `free` within reach of the seed that a motion carries.
std::vector<int> PointsOf(const Rigid3d& motion,
                          const std::vector<PointMotion>& motions,
                          const std::vector<char>& free,
                          const Eigen::Vector3f& seed, double inlier,
                          double reach) {
  std::vector<int> points;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const Eigen::Vector3d from = motions[i].from.cast<double>();
    if (free[i] != 0 && (motions[i].from - seed).norm() <= reach &&
        (motion * from - motions[i].to.cast<double>()).norm() <= inlier) {
      points.push_back(static_cast<int>(i));
    }
  }
  return points;
}

/// The rigid motion of these points, least squares.
Rigid3d MotionOf(const std::vector<int>& points,
                 const std::vector<PointMotion>& motions) {
  Eigen::Matrix3Xd from(3, points.size()), to(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    from.col(i) = motions[points[i]].from.cast<double>();
    to.col(i) = motions[points[i]].to.cast<double>();
  }
  return Rigid3d(Eigen::umeyama(from, to, /*with_scaling=*/false));
}

struct Candidate {
  Eigen::Vector3f seed;
  Rigid3d motion;
};

}  // namespace

void RigidPartOptions::List(OptionList* list) {
  list->Number("parts", &count, Range::AtLeast(0), "",
               "Before a deforming surface deforms, so many parts of it at "
               "most start where points were matched; 0: none.");
  list->Number("part_radius", &radius, Range::Above(0), "metres",
               "Of the ball of point motions from which a part is drawn.");
  list->Number("part_reach", &reach, Range::Above(0), "metres",
               "A part has no points farther from that ball's centre.");
  list->Number("part_inlier", &inlier, Range::Above(0), "metres",
               "Points of a part agree with its motion within this and two "
               "standard deviations of the depth noise.");
  list->Number("part_min_points", &min_points, Range::AtLeast(4), "points",
               "Fewer are no part.");
}

std::vector<RigidPart> FindRigidParts(const std::vector<PointMotion>& motions,
                                      const DepthNoise& noise,
                                      const RigidPartOptions& options) {
  std::vector<RigidPart> parts;
  if (static_cast<int>(motions.size()) < options.min_points) return parts;
  const auto inlier_at = [&](const Eigen::Vector3f& seed) {
    return options.inlier + 2 * noise.Sigma(static_cast<double>(seed.z()));
  };
  std::vector<Candidate> candidates;
  for (const int index : SpreadSeeds(motions, options.radius / 2)) {
    const Eigen::Vector3f& seed = motions[index].from;
    const auto motion = MotionAbout(motions, seed, inlier_at(seed), options);
    if (motion) candidates.push_back({seed, *motion});
  }
  std::vector<char> free(motions.size(), 1);
  while (static_cast<int>(parts.size()) < options.count) {
    RigidPart best;
    for (const Candidate& candidate : candidates) {
      const double inlier = inlier_at(candidate.seed);
      Rigid3d motion = candidate.motion;
      std::vector<int> points = PointsOf(motion, motions, free, candidate.seed,
                                         inlier, options.reach);
      if (points.size() <= best.points.size() ||
          static_cast<int>(points.size()) < options.min_points) {
        continue;
      }
      motion = MotionOf(points, motions);
      points = PointsOf(motion, motions, free, candidate.seed, inlier,
                        options.reach);
      if (points.size() > best.points.size()) best = {motion, points};
    }
    if (static_cast<int>(best.points.size()) < options.min_points) break;
    for (const int point : best.points) free[point] = 0;
    parts.push_back(std::move(best));
  }
  return parts;
}

}  // namespace splitfusion
