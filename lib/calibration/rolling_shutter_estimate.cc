#include "splitfusion/lib/calibration/rolling_shutter_estimate.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/median.h"
#include "splitfusion/lib/base/pi.h"

namespace splitfusion {
namespace {

constexpr int kMoments = 30;     // Speed: at which velocities are measured.
constexpr int kMostPairs = 12;   // Speed.
constexpr int kTriedPairs = 60;  // Speed: until so many are found.
constexpr int kFeatures = 1500;  // Speed.
/// Features that have to agree on a motion.
constexpr int kLeastMatches = 40;
/// Features of frames that follow one another agree within this, pixels ...
constexpr double kStepReach = 3;
/// ... and of frames that are distorted differently.
constexpr double kPairReach = 12;
/// Pairs whose rotations differ by less a frame, degrees, tell nothing ...
constexpr double kLeastTurn = 2;
/// ... nor if that is less than so many times as much as is uncertain of it.
constexpr double kLeastCertainty = 4;
/// What is nearer is left out, metres: it may come to lie behind the camera.
constexpr double kLeastDepth = 0.2;
/// Errors of features from which on they count less, pixels.
constexpr double kFeatureError = 1;

/// Rotation vector, translation (metres).
using Motion = std::array<double, 6>;

struct FeatureFrame {
  double timestamp = 0;
  std::vector<cv::Point2f> pixels;
  std::vector<cv::Point3f> points;  // Camera frame, metres.
  cv::Mat descriptors;
};

struct AgreeingFeatures {
  Motion motion;  // Of points, from the first frame to the second.
  std::vector<std::pair<int, int>> matches;
};

/// Two frames that tell.
struct FramePair {
  int from = 0;     // Moments.
  int to = 0;       // As `from`.
  double turn = 0;  // Radians a frame.
  AgreeingFeatures agreeing;
};

FeatureFrame FindFeatures(const Frame& frame, const PinholeCamera& camera) {
  cv::Mat grey;
  cv::cvtColor(frame.color, grey, cv::COLOR_BGR2GRAY);
  std::vector<cv::KeyPoint> keys;
  cv::Mat all;
  cv::ORB::create(kFeatures)->detectAndCompute(grey, cv::noArray(), keys, all);
  FeatureFrame found;
  found.timestamp = frame.timestamp;
  const cv::Mat_<float> depth = frame.depth;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const cv::Point2f& place = keys[i].pt;
    const auto pixel = camera.PixelAt({place.x, place.y});
    const float z = pixel ? depth(pixel->y(), pixel->x()) : 0.f;
    if (!(z > 0)) continue;
    const Eigen::Vector3f point = camera.BackProject(place.x, place.y, z);
    found.pixels.push_back(place);
    found.points.emplace_back(point.x(), point.y(), point.z());
    found.descriptors.push_back(all.row(static_cast<int>(i)));
  }
  return found;
}

std::optional<AgreeingFeatures> Agreeing(const FeatureFrame& from,
                                         const FeatureFrame& to,
                                         const PinholeCamera& camera,
                                         double reach) {
  if (from.descriptors.empty() || to.descriptors.empty()) return std::nullopt;
  std::vector<cv::DMatch> matches;
  cv::BFMatcher(cv::NORM_HAMMING, /*crossCheck=*/true)
      .match(from.descriptors, to.descriptors, matches);
  if (static_cast<int>(matches.size()) < kLeastMatches) return std::nullopt;
  std::vector<cv::Point3f> points;
  std::vector<cv::Point2f> pixels;
  for (const cv::DMatch& match : matches) {
    points.push_back(from.points[match.queryIdx]);
    pixels.push_back(to.pixels[match.trainIdx]);
  }
  const cv::Matx33d intrinsics(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy,
                               0, 0, 1);
  constexpr int kTrials = 300;         // Speed.
  constexpr double kConfidence = .99;  // Maths.
  cv::Vec3d rotation, translation;
  std::vector<int> inliers;
  if (!cv::solvePnPRansac(points, pixels, intrinsics, cv::noArray(), rotation,
                          translation, false, kTrials,
                          static_cast<float>(reach), kConfidence, inliers)) {
    return std::nullopt;
  }
  AgreeingFeatures agreeing{{rotation[0], rotation[1], rotation[2],
                             translation[0], translation[1], translation[2]},
                            {}};
  // It is refined without a limit, and may have gone astray.
  cv::Matx33d turned;
  cv::Rodrigues(rotation, turned);
  for (const int i : inliers) {
    const cv::Vec3d there =
        turned * cv::Vec3d(points[i].x, points[i].y, points[i].z) + translation;
    if (!(there[2] > kLeastDepth)) continue;
    const cv::Vec3d place = intrinsics * there / there[2];
    const double off =
        std::hypot(place[0] - pixels[i].x, place[1] - pixels[i].y);
    if (off > reach) continue;
    agreeing.matches.emplace_back(matches[i].queryIdx, matches[i].trainIdx);
  }
  if (static_cast<int>(agreeing.matches.size()) < kLeastMatches) {
    return std::nullopt;
  }
  return agreeing;
}

/// Frames in which the velocity of the camera is known.
struct Moments {
  std::vector<FeatureFrame> frames;
  std::vector<Motion> velocities;  // Of points, a second.
  std::vector<double> intervals;   // To the frame before, seconds.
  std::vector<double> errors;      // Of the turn, radians a frame.

  Eigen::Vector3d Turn(int i) const {
    return intervals[i] * Eigen::Vector3d(velocities[i].data());
  }
};

/// Of points, a second, by features of two frames.
std::optional<Motion> VelocityBetween(const FeatureFrame& from,
                                      const FeatureFrame& to,
                                      const PinholeCamera& camera) {
  const double interval = to.timestamp - from.timestamp;
  if (!(interval > 0)) return std::nullopt;
  const auto step = Agreeing(from, to, camera, kStepReach);
  if (!step) return std::nullopt;
  Motion velocity = step->motion;
  for (double& value : velocity) value /= interval;
  return velocity;
}

/// The velocity in the middle of three frames is the mean of those before and
/// after it.
Moments FindMoments(const std::function<std::optional<Frame>(int)>& read,
                    int frames, const PinholeCamera& camera) {
  const int count = std::max(0, std::min(frames - 2, kMoments));
  struct Moment {
    std::array<FeatureFrame, 3> frames;
    std::optional<Motion> velocity;
    double error = 0;
  };
  std::vector<Moment> found(count);
  tbb::parallel_for(0, count, [&](int i) {
    Moment& moment = found[i];
    const auto first = static_cast<int>(std::int64_t{i} * (frames - 2) / count);
    for (int k = 0; k < 3; ++k) {
      const std::optional<Frame> frame = read(first + k);
      if (!frame) return;
      moment.frames[k] = FindFeatures(*frame, camera);
    }
    const auto& [before, now, after] = moment.frames;
    moment.velocity = VelocityBetween(before, now, camera);
    const std::optional<Motion> next = VelocityBetween(now, after, camera);
    if (!next) moment.velocity.reset();
    if (!moment.velocity) return;
    const Eigen::Map<const Eigen::Vector3d> turn(moment.velocity->data());
    const Eigen::Map<const Eigen::Vector3d> next_turn(next->data());
    moment.error =
        (now.timestamp - before.timestamp) * (next_turn - turn).norm() / 2;
    for (std::size_t k = 0; k < next->size(); ++k) {
      (*moment.velocity)[k] = ((*moment.velocity)[k] + (*next)[k]) / 2;
    }
  });
  Moments moments;
  for (Moment& moment : found) {
    if (!moment.velocity) continue;
    moments.velocities.push_back(*moment.velocity);
    moments.intervals.push_back(moment.frames[1].timestamp -
                                moment.frames[0].timestamp);
    moments.errors.push_back(moment.error);
    moments.frames.push_back(std::move(moment.frames[1]));
  }
  return moments;
}

/// Those that are distorted most differently, of those that show the same; none
/// share a frame: where something large moves, the velocity of a frame may be
/// that of it, and all pairs with that frame would be wrong alike.
std::vector<FramePair> FindPairs(const Moments& moments,
                                 const PinholeCamera& camera) {
  std::vector<FramePair> all;
  const auto count = static_cast<int>(moments.frames.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      const double turn = (moments.Turn(i) - moments.Turn(j)).norm();
      const double uncertain = moments.errors[i] + moments.errors[j];
      if (turn > kLeastTurn * kPi<double> / 180 &&
          turn > kLeastCertainty * uncertain) {
        all.push_back({i, j, turn, {}});
      }
    }
  }
  std::stable_sort(
      all.begin(), all.end(),
      [](const FramePair& a, const FramePair& b) { return a.turn > b.turn; });
  std::vector<FramePair> pairs;
  std::vector<char> used(count, false);
  int tried = 0;
  for (FramePair& pair : all) {
    if (used[pair.from] != 0 || used[pair.to] != 0) continue;
    if (tried++ == kTriedPairs) break;
    auto agreeing = Agreeing(moments.frames[pair.from], moments.frames[pair.to],
                             camera, kPairReach);
    if (!agreeing) continue;
    used[pair.from] = used[pair.to] = true;
    pair.agreeing = std::move(*agreeing);
    pairs.push_back(std::move(pair));
    if (pairs.size() == kMostPairs) break;
  }
  return pairs;
}

/// u - pi(X' + k(u) t V_j X'), pixels.
struct RolledReprojection {
  const PinholeCamera& camera;
  const Motion& from_velocity;
  const Motion& to_velocity;
  Eigen::Vector3d point;  // X of the first frame.
  double from_share;      // k of its row.
  Eigen::Vector2d pixel;  // u of the second frame.
  double to_share;        // k of its row.

  /// V X.
  template <typename T>
  static Eigen::Matrix<T, 3, 1> Velocity(const Motion& v,
                                         const Eigen::Matrix<T, 3, 1>& x) {
    const Eigen::Map<const Eigen::Vector3d> turn(v.data()), shift(&v[3]);
    return turn.cast<T>().cross(x) + shift.cast<T>();
  }

  template <typename T>
  bool operator()(const T* motion, const T* seconds, T* residual) const {
    const Eigen::Matrix<T, 3, 1> x = point.cast<T>();
    const Eigen::Matrix<T, 3, 1> middle =
        x - T(from_share) * seconds[0] * Velocity<T>(from_velocity, x);
    Eigen::Matrix<T, 3, 1> there;
    ceres::AngleAxisRotatePoint(motion, middle.data(), there.data());
    for (int k = 0; k < 3; ++k) there[k] += motion[3 + k];
    there += T(to_share) * seconds[0] * Velocity<T>(to_velocity, there);
    if (!(there.z() > T(kNearPlane))) return false;
    const Eigen::Matrix<T, 2, 1> place = camera.Project<T>(there);
    residual[0] = place.x() - T(pixel.x());
    residual[1] = place.y() - T(pixel.y());
    return true;
  }
};

/// t of some pairs, seconds; none if it cannot be found.
std::optional<double> Solve(const Moments& moments,
                            const std::vector<FramePair>& pairs,
                            const PinholeCamera& camera) {
  ceres::Problem problem;
  std::vector<Motion> motions;
  for (const FramePair& pair : pairs) motions.push_back(pair.agreeing.motion);
  double seconds = 0;
  const auto share = [&](const cv::Point2f& pixel) {
    return (pixel.y + 0.5) / camera.height - 0.5;
  };
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const FeatureFrame& from = moments.frames[pairs[p].from];
    const FeatureFrame& to = moments.frames[pairs[p].to];
    for (const auto& [i, j] : pairs[p].agreeing.matches) {
      using Cost =
          ceres::AutoDiffCostFunction<RolledReprojection, 2, 6, 1>;  // Layout.
      const cv::Point3f& x = from.points[i];
      problem.AddResidualBlock(
          new Cost(new RolledReprojection{
              camera, moments.velocities[pairs[p].from],
              moments.velocities[pairs[p].to], Eigen::Vector3d(x.x, x.y, x.z),
              share(from.pixels[i]),
              Eigen::Vector2d(to.pixels[j].x, to.pixels[j].y),
              share(to.pixels[j])}),
          new ceres::CauchyLoss(kFeatureError), motions[p].data(), &seconds);
    }
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;
  return seconds;
}

}  // namespace

bool RollingShutterEstimate::IsNeeded() const {
  constexpr double kLeastShare = 0.15;
  constexpr int kLeastPairs = 4;
  // What moves by itself pulls several pairs alike, which their scatter does
  // not show.
  constexpr double kCertain = 5;
  return pairs >= kLeastPairs && seconds > kCertain * error &&
         seconds > kLeastShare * interval &&
         seconds - kCertain * error < interval;
}

std::string RollingShutterEstimate::Text() const {
  return cv::format(
      "rows are exposed one after the other, the last one %.1f ms after the "
      "first (+- %.1f, by %d pairs of frames whose rotations differ by %.1f "
      "degrees a frame)",
      1000 * seconds, 1000 * error, pairs, turn);
}

RollingShutterEstimate EstimateRollingShutter(
    const std::function<std::optional<Frame>(int)>& read, int frames,
    const PinholeCamera& camera) {
  RollingShutterEstimate estimate;
  const Moments moments = FindMoments(read, frames, camera);
  if (moments.frames.empty()) return estimate;
  estimate.interval = Median(moments.intervals);
  const std::vector<FramePair> pairs = FindPairs(moments, camera);
  std::vector<double> singles, turns;
  for (const FramePair& pair : pairs) {
    const std::optional<double> single = Solve(moments, {pair}, camera);
    if (!single) continue;
    singles.push_back(*single);
    turns.push_back(pair.turn * 180 / kPi<double>);
  }
  const std::optional<double> all =
      singles.empty() ? std::nullopt : Solve(moments, pairs, camera);
  if (!all) return estimate;
  estimate.seconds = *all;
  estimate.pairs = static_cast<int>(singles.size());
  estimate.turn = Median(turns);
  for (double& single : singles) single = std::abs(single - *all);
  constexpr double kDeviations = 1.4826;  // Maths: of a median of distances.
  estimate.error =
      kDeviations * Median(singles) / std::sqrt(double(estimate.pairs));
  return estimate;
}

}  // namespace splitfusion
