#include "splitfusion/lib/evaluation/seen_score.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/evaluation/surface_error.h"
#include "splitfusion/lib/geometry/kd_tree.h"

namespace splitfusion {
namespace {

/// Of a vertex's pixel from one that shows it, in both directions.
constexpr int kSeenReach = 2;
/// Of a seen vertex from the live depth, metres.
constexpr double kDepthTolerance = 0.03;
constexpr int kSamples = 30000;
constexpr unsigned kModelSeed = 3;
constexpr unsigned kTruthSeed = 4;
constexpr unsigned kSeenSeed = 5;

/// Surface id -> scores by frame.
using Scores = std::map<int, std::map<int, SeenFrame>>;

/// Whether the live images show a point (camera frame) of an instance.
bool IsShown(const Eigen::Vector3d& point, int instance,
             const PinholeCamera& camera, const cv::Mat_<std::uint16_t>& labels,
             const cv::Mat_<float>& depth) {
  const auto pixel = camera.PixelOf(point.cast<float>());
  const cv::Rect inner(kSeenReach, kSeenReach, labels.cols - 2 * kSeenReach,
                       labels.rows - 2 * kSeenReach);
  if (!pixel || !cv::Point(pixel->x(), pixel->y()).inside(inner)) return false;
  for (const int dv : {-kSeenReach, 0, kSeenReach}) {
    for (const int du : {-kSeenReach, 0, kSeenReach}) {
      const cv::Point at(pixel->x() + du, pixel->y() + dv);
      if (labels(at) == instance && depth(at) > 0 &&
          std::abs(depth(at) - point.z()) < kDepthTolerance) {
        return true;
      }
    }
  }
  return false;
}

/// Part of the points that are nearer than kSeenThreshold to one of the others.
double PartWithin(const std::vector<Eigen::Vector3f>& points,
                  const KdTree& others) {
  std::vector<char> near(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    near[i] = others.HasNear(points[i], kSeenThreshold);
  });
  const auto count = std::count(near.begin(), near.end(), true);
  return static_cast<double>(count) / static_cast<double>(points.size());
}

/// What was seen of one instance so far, and what the surfaces make of it.
class Witness {
 public:
  Witness(const std::vector<AnimatedSurface>& surfaces, const LiveImages& live,
          const std::string& label_folder, int plain_view_pixels)
      : surfaces_(surfaces),
        live_(live),
        label_folder_(label_folder),
        plain_view_pixels_(plain_view_pixels) {}

  void Add(const TrueOccasion& occasion) {
    const cv::Mat_<std::uint16_t> labels =
        ReadIds(label_folder_, *occasion.frame, live_.camera());
    if (labels.empty()) return;
    const cv::Mat_<float> depth = live_.Depth(*occasion.frame);
    Look(occasion, labels, depth);
    began_ = began_ || CountPixels(labels, &depth)[occasion.instance] >
                           plain_view_pixels_;
    if (!began_) return;
    const std::vector<double> weights = SeenWeights(occasion.truth.mesh);
    const std::vector<Eigen::Vector3f> seen =
        SampleSurface(occasion.truth.mesh, kSamples, kSeenSeed, weights);
    if (seen.empty()) return;
    const std::vector<Eigen::Vector3f> truth =
        SampleSurface(occasion.truth.mesh, kSamples, kTruthSeed);
    frames_.push_back(occasion.frame->index);
    const KdTree truth_tree(truth);
    for (const AnimatedSurface& surface : surfaces_) {
      Score(surface, occasion, truth_tree, seen);
    }
  }

  SeenScore Best() const {
    SeenScore best;
    for (const int frame : frames_) best.frames.push_back({frame, 0, 0, 0});
    for (const auto& [surface, scores] : scores_) {
      const SeenScore score = Of(surface);
      if (score.Mean().f_score > best.Mean().f_score) best = score;
    }
    return best;
  }

 private:
  void Look(const TrueOccasion& occasion, const cv::Mat_<std::uint16_t>& labels,
            const cv::Mat_<float>& depth) {
    const Rigid3d camera_from_world = occasion.world_from_camera.inverse();
    const auto& vertices = occasion.truth.mesh.vertices;
    seen_.resize(vertices.size(), false);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (seen_[i]) continue;
      seen_[i] = IsShown(camera_from_world * vertices[i].cast<double>(),
                         occasion.instance, live_.camera(), labels, depth);
    }
  }

  /// Of every triangle, the part of its corners that were seen.
  std::vector<double> SeenWeights(const TriangleMesh& mesh) const {
    std::vector<double> weights;
    for (const Eigen::Vector3i& t : mesh.triangles) {
      weights.push_back((seen_[t[0]] + seen_[t[1]] + seen_[t[2]]) / 3.0);
    }
    return weights;
  }

  void Score(const AnimatedSurface& surface, const TrueOccasion& occasion,
             const KdTree& truth, const std::vector<Eigen::Vector3f>& seen) {
    const int frame = occasion.frame->index;
    if (surface.background() || !surface.HasMotions(frame)) return;
    const TriangleMesh model = ModelInWorld(surface, occasion);
    if (model.triangles.empty()) return;
    const std::vector<Eigen::Vector3f> points =
        SampleSurface(model, kSamples, kModelSeed);
    if (points.empty()) return;
    SeenFrame& score = scores_[surface.recorded().id][frame];
    score.frame = frame;
    score.precision = PartWithin(points, truth);
    score.recall = PartWithin(seen, KdTree(points));
    score.f_score = HarmonicMean(score.precision, score.recall);
  }

  SeenScore Of(int surface) const {
    SeenScore score;
    score.surface_id = surface;
    const auto& found = scores_.at(surface);
    for (const int frame : frames_) {
      const auto item = found.find(frame);
      score.frames.push_back(item != found.end() ? item->second
                                                 : SeenFrame{frame, 0, 0, 0});
    }
    return score;
  }

  const std::vector<AnimatedSurface>& surfaces_;
  const LiveImages& live_;
  const std::string& label_folder_;
  int plain_view_pixels_;
  std::vector<char> seen_;  // By vertex.
  bool began_ = false;      // The instance was in plain view.
  std::vector<int> frames_;
  Scores scores_;
};

}  // namespace

SeenFrame SeenScore::Mean() const {
  SeenFrame mean{-1, 0, 0, 0};
  const double weight = frames.empty() ? 0 : 1.0 / frames.size();
  for (const SeenFrame& item : frames) {
    mean.precision += item.precision * weight;
    mean.recall += item.recall * weight;
    mean.f_score += item.f_score * weight;
  }
  return mean;
}

std::map<int, SeenScore> ScoreSeen(const std::vector<AnimatedSurface>& surfaces,
                                   const std::vector<TrueOccasion>& occasions,
                                   const LiveImages& live,
                                   const std::string& label_folder,
                                   int plain_view_pixels) {
  std::map<int, Witness> witnesses;
  for (const TrueOccasion& occasion : occasions) {
    witnesses
        .try_emplace(occasion.instance, surfaces, live, label_folder,
                     plain_view_pixels)
        .first->second.Add(occasion);
  }
  std::map<int, SeenScore> scores;
  for (const auto& [instance, witness] : witnesses) {
    scores[instance] = witness.Best();
  }
  return scores;
}

}  // namespace splitfusion
