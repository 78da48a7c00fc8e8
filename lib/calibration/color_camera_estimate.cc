#include "splitfusion/lib/calibration/color_camera_estimate.h"

#include <ceres/ceres.h>
#include <ceres/cubic_interpolation.h>
#include <ceres/rotation.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/median.h"
#include "splitfusion/lib/frame/depth_edges.h"

namespace splitfusion {
namespace {

constexpr int kFrames = 24;             // Speed: read of a sequence, at most.
constexpr double kPointsAFrame = 1500;  // Speed: of depth edges, at most.
constexpr int kLeastPoints = 100;  // Maths: an edge or two tell no direction.
/// Strengths above count no more: one bright window is one edge.
constexpr double kStrongest = 4;
/// Smoothing before the gradient, pixels: noise.
constexpr double kNoiseSigma = 1.2;
/// Strengths are relative to the mean gradient this far around, pixels: shaded
/// and bright parts, blurred and sharp images count alike.
constexpr double kAroundSigma = 25;
/// A gradient of image noise, grey values of 255 a pixel.
constexpr float kNoiseGradient = 2;
/// Blur of the strengths, pixels: the first reaches as far as the steps of the
/// search, the last one is an edge's own width.
constexpr std::array<double, 2> kBlurs = {2.5, 1.2};
constexpr std::size_t kSearchPoints = 16;  // Speed: every so many are asked.
constexpr std::size_t kStartPoints = 24;   // Speed: as above, from its starts.
/// Of the search over shifts of the whole image, pixels of 640 in a row.
constexpr int kSearchStep = 6;
constexpr int kSearchReach = 60;
/// What is known of cameras: two in one housing look the same way and are
/// centimetres apart, side by side. Standard deviations.
constexpr double kRotationSigma = 0.035;  // 2 degrees.
constexpr std::array<double, 3> kTranslationSigma = {0.03, 0.01, 0.01};
constexpr double kFocalSigma = 0.1;  // Of the logarithm of the ratio.
/// Focal lengths that are searched, of that of the depth camera.
constexpr std::array<double, 7> kFocalRatios = {0.8, 0.85, 0.9, 0.95,
                                                1,   1.05, 1.1};
/// Places beside the depth camera that are searched, metres.
constexpr std::array<double, 3> kSides = {-0.025, 0, 0.025};
/// Depth edges of structured light and stereo lie beside the true ones by so
/// much, pixels.
constexpr double kEdgeError = 3;
/// By how much colour gets stronger at depth edges when images that lie apart
/// are registered: 2.2 times and more on stretches of 7-Scenes. On images that
/// their makers registered up to 1.7 (TUM RGB-D, KillingFusion; single frames,
/// short stretches, standing cameras).
constexpr double kGain = 1.9;

/// Rotation vector, translation (metres), logarithm of the focal ratio.
using Parameters = std::array<double, 7>;

/// What one frame says.
struct EdgeFrame {
  std::vector<Eigen::Vector3d> points;  ///< Near sides, depth camera, metres.
  std::array<cv::Mat_<float>, kBlurs.size()> strength;  ///< Of the colour.
};

/// Pixel of the colour image at which a point of the depth camera is seen.
template <typename T>
void ProjectToColor(const PinholeCamera& camera, const T* p,
                    const Eigen::Vector3d& point, T* u, T* v) {
  const T x[3] = {T(point.x()), T(point.y()), T(point.z())};
  T y[3];
  ceres::AngleAxisRotatePoint(p, x, y);
  for (int d = 0; d < 3; ++d) y[d] += p[3 + d];
  const T ratio = exp(p[6]);
  *u = ratio * camera.fx * y[0] / y[2] + camera.cx;
  *v = ratio * camera.fy * y[1] / y[2] + camera.cy;
}

/// The strength that an edge point lacks.
struct MissingStrength {
  using Grid = ceres::Grid2D<float>;
  const PinholeCamera& camera;
  const ceres::BiCubicInterpolator<Grid>& strength;
  Eigen::Vector3d point;
  double scale;  ///< Of the residual.

  template <typename T>
  bool operator()(const T* p, T* residual) const {
    T u, v, value;
    ProjectToColor(camera, p, point, &u, &v);
    strength.Evaluate(v, u, &value);
    residual[0] = scale * (kStrongest - value);
    return true;
  }
};

/// How far a parameter is from registered images, in standard deviations.
struct NearRegistered {
  template <typename T>
  bool operator()(const T* p, T* residual) const {
    for (int d = 0; d < 3; ++d) {
      residual[d] = p[d] / kRotationSigma;
      residual[3 + d] = p[3 + d] / kTranslationSigma[d];
    }
    residual[6] = p[6] / kFocalSigma;
    return true;
  }
};

std::array<cv::Mat_<float>, kBlurs.size()> EdgeStrengths(const cv::Mat& color) {
  cv::Mat grey, smooth, by_u, by_v, gradient, around;
  cv::cvtColor(color, grey, cv::COLOR_BGR2GRAY);
  grey.convertTo(grey, CV_32F);
  cv::GaussianBlur(grey, smooth, cv::Size(), kNoiseSigma);
  cv::Sobel(smooth, by_u, CV_32F, 1, 0);
  cv::Sobel(smooth, by_v, CV_32F, 0, 1);
  cv::magnitude(by_u, by_v, gradient);
  cv::GaussianBlur(gradient, around, cv::Size(), kAroundSigma);
  cv::Mat strength = gradient / (around + kNoiseGradient);
  strength = cv::min(strength, kStrongest);
  std::array<cv::Mat_<float>, kBlurs.size()> blurred;
  for (std::size_t i = 0; i < kBlurs.size(); ++i) {
    cv::GaussianBlur(strength, blurred[i], cv::Size(), kBlurs[i]);
  }
  return blurred;
}

/// Points of the near sides of depth edges, between it and the far side's
/// pixel; evenly chosen if there are many.
std::vector<Eigen::Vector3d> NearSides(const cv::Mat_<float>& depth,
                                       const PinholeCamera& camera) {
  const auto focal_length = static_cast<float>(camera.fx);
  std::vector<Eigen::Vector3d> points;
  for (int v = 1; v + 1 < depth.rows; ++v) {
    for (int u = 1; u + 1 < depth.cols; ++u) {
      const float z = depth(v, u);
      if (!(z > 0)) continue;
      for (const auto& [du, dv] : {std::pair(1, 0), std::pair(-1, 0),
                                   std::pair(0, 1), std::pair(0, -1)}) {
        const float beside = depth(v + dv, u + du);
        if (beside < z + EdgeJump(z, 1, focal_length, camera.noise)) continue;
        points.push_back(camera.BackProject<double>(u + 0.5 * du, v + 0.5 * dv,
                                                    static_cast<double>(z)));
      }
    }
  }
  const double step = std::max(1.0, points.size() / kPointsAFrame);
  std::vector<Eigen::Vector3d> chosen;
  for (double i = 0; i < static_cast<double>(points.size()); i += step) {
    chosen.push_back(points[static_cast<std::size_t>(i)]);
  }
  return chosen;
}

std::vector<EdgeFrame> FindEdges(const std::vector<Frame>& frames,
                                 const PinholeCamera& camera) {
  std::vector<EdgeFrame> all(frames.size());
  tbb::parallel_for(std::size_t{0}, frames.size(), [&](std::size_t i) {
    all[i].points = NearSides(frames[i].depth, camera);
    if (all[i].points.size() < kLeastPoints) return;
    all[i].strength = EdgeStrengths(frames[i].color);
  });
  all.erase(std::remove_if(all.begin(), all.end(),
                           [](const EdgeFrame& frame) {
                             return frame.points.size() < kLeastPoints;
                           }),
            all.end());
  return all;
}

/// Mean strength of the colour at every `step`-th edge point of a frame; the
/// nearest pixel's, 0 beyond the image.
double MeanStrength(const EdgeFrame& frame, const PinholeCamera& camera,
                    const Parameters& p, std::size_t blur,
                    std::size_t step = 1) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < frame.points.size(); i += step, ++count) {
    double u, v;
    ProjectToColor(camera, p.data(), frame.points[i], &u, &v);
    const auto pixel = camera.PixelAt(Eigen::Vector2d(u, v).cast<float>());
    if (pixel) sum += frame.strength[blur](pixel->y(), pixel->x());
  }
  return sum / count;
}

/// The shift of the whole image, as a rotation, at which the colour is
/// strongest with a focal length and a colour camera beside.
Parameters BestShift(const std::vector<EdgeFrame>& frames,
                     const PinholeCamera& camera, double ratio, double side) {
  const double unit = camera.width / 640.0;  // Unit.
  Parameters best{};
  double most = -1;
  for (int dv = -kSearchReach / 2; dv <= kSearchReach / 2; dv += kSearchStep) {
    for (int du = -kSearchReach; du <= kSearchReach; du += kSearchStep) {
      const Parameters p{
          -dv * unit / camera.fy, du * unit / camera.fx, 0, side, 0, 0,
          std::log(ratio)};
      double strength = 0;
      for (const EdgeFrame& frame : frames) {
        strength += MeanStrength(frame, camera, p, 0, kSearchPoints);
      }
      if (strength > most) most = strength, best = p;
    }
  }
  return best;
}

/// Each frame counts as one measurement of the mean strength, with the spread
/// of a single point's; every `step`-th point is asked. Returns the least cost.
double Refine(const std::vector<EdgeFrame>& frames, const PinholeCamera& camera,
              std::size_t blur, std::size_t step, Parameters* p) {
  std::vector<std::unique_ptr<MissingStrength::Grid>> grids;
  std::vector<
      std::unique_ptr<ceres::BiCubicInterpolator<MissingStrength::Grid>>>
      strengths;
  ceres::Problem problem;
  for (const EdgeFrame& frame : frames) {
    const cv::Mat_<float>& image = frame.strength[blur];
    grids.push_back(std::make_unique<MissingStrength::Grid>(
        image[0], 0, image.rows, 0, image.cols));
    strengths.push_back(
        std::make_unique<ceres::BiCubicInterpolator<MissingStrength::Grid>>(
            *grids.back()));
    const std::size_t count = (frame.points.size() + step - 1) / step;
    const double scale = 1 / std::sqrt(double(count));
    for (std::size_t i = 0; i < frame.points.size(); i += step) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<MissingStrength, 1, 7>(
              new MissingStrength{camera, *strengths.back(), frame.points[i],
                                  scale}),
          nullptr, p->data());
    }
  }
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<NearRegistered, 7, 7>(new NearRegistered),
      nullptr, p->data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.num_threads = 1;  // Sums in one order.
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.final_cost;
}

/// The same with ever less blur; the cost is that of the last.
double Refine(const std::vector<EdgeFrame>& frames, const PinholeCamera& camera,
              std::size_t step, Parameters* p) {
  double cost = 0;
  for (std::size_t blur = 0; blur < kBlurs.size(); ++blur) {
    cost = Refine(frames, camera, blur, step, p);
  }
  return cost;
}

/// The parameters of least cost. Edges fit halfway at many wrong places, where
/// the search from a single start ends; so it begins at the best shift for each
/// focal length and each place beside the depth camera, and the one that ends
/// with the least cost is refined with all points.
Parameters Minimise(const std::vector<EdgeFrame>& frames,
                    const PinholeCamera& camera) {
  constexpr std::size_t kStarts = kSides.size() * kFocalRatios.size();
  std::array<Parameters, kStarts> starts;
  std::array<double, kStarts> costs;
  tbb::parallel_for(std::size_t{0}, kStarts, [&](std::size_t i) {
    starts[i] = BestShift(frames, camera, kFocalRatios[i % kFocalRatios.size()],
                          kSides[i / kFocalRatios.size()]);
    costs[i] = Refine(frames, camera, kStartPoints, &starts[i]);
  });
  Parameters best =
      starts[std::min_element(costs.begin(), costs.end()) - costs.begin()];
  Refine(frames, camera, 1, &best);
  return best;
}

ColorCamera ToColorCamera(const Parameters& p, const PinholeCamera& camera) {
  ColorCamera color = ColorCamera::Registered(camera);
  color.fx *= std::exp(p[6]);
  color.fy *= std::exp(p[6]);
  const Eigen::Vector3d rotation(p[0], p[1], p[2]);
  if (rotation.norm() > 0) {
    color.color_from_depth.linear() =
        Eigen::AngleAxisd(rotation.norm(), rotation.normalized())
            .toRotationMatrix();
  }
  color.color_from_depth.translation() = Eigen::Vector3d(p[3], p[4], p[5]);
  return color;
}

void Judge(const std::vector<EdgeFrame>& frames, const PinholeCamera& camera,
           const Parameters& p, ColorCameraEstimate* estimate) {
  const Parameters registered{};
  const std::size_t finest = kBlurs.size() - 1;
  std::vector<float> shifts;
  for (const EdgeFrame& frame : frames) {
    estimate->strength_before +=
        MeanStrength(frame, camera, registered, finest) / frames.size();
    estimate->strength_after +=
        MeanStrength(frame, camera, p, finest) / frames.size();
    for (const Eigen::Vector3d& point : frame.points) {
      double u, v;
      ProjectToColor(camera, p.data(), point, &u, &v);
      const Eigen::Vector2d shift =
          Eigen::Vector2d(u, v) - camera.Project<double>(point);
      shifts.push_back(static_cast<float>(shift.norm()));
    }
  }
  estimate->shift = Median(std::move(shifts));
}

}  // namespace

bool ColorCameraEstimate::IsNeeded() const {
  return frames > 1 && shift > kEdgeError &&
         strength_after > kGain * strength_before;
}

ColorCameraEstimate EstimateColorCamera(const std::vector<Frame>& frames,
                                        const PinholeCamera& camera) {
  ColorCameraEstimate estimate;
  estimate.camera = ColorCamera::Registered(camera);
  const std::vector<EdgeFrame> edges = FindEdges(frames, camera);
  estimate.frames = static_cast<int>(edges.size());
  if (estimate.frames < 2) return estimate;
  const Parameters p = Minimise(edges, camera);
  estimate.camera = ToColorCamera(p, camera);
  Judge(edges, camera, p, &estimate);
  return estimate;
}

ColorCameraEstimate EstimateColorCamera(const ImageFolderReader& reader) {
  const int size = reader.size();
  const int count = std::min(size, kFrames);
  std::vector<std::optional<Frame>> read(count);
  tbb::parallel_for(0, count, [&](int i) {
    try {
      read[i] = reader.Read(static_cast<int>(std::int64_t{i} * size / count));
    } catch (const InputError&) {  // The run says so when it gets there.
    }
  });
  std::vector<Frame> frames;
  for (std::optional<Frame>& frame : read) {
    if (frame) frames.push_back(std::move(*frame));
  }
  return EstimateColorCamera(frames, reader.camera());
}

std::string ColorCameraEstimate::Text() const {
  const Eigen::Vector3d t = 1000 * camera.color_from_depth.translation();
  return cv::format(
      "colour is %.1f pixels beside depth (median at the depth edges of %d "
      "frames, where the strength of colour edges is %.2f, and registered "
      "%.2f): colour camera with a focal length of %.1f pixels at %.0f %.0f "
      "%.0f mm",
      shift, frames, strength_before, strength_after, camera.fx, t.x(), t.y(),
      t.z());
}

}  // namespace splitfusion
