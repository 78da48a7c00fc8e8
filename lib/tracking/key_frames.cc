#include "splitfusion/lib/tracking/key_frames.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

constexpr int kBackground = 0;  // Layout.
/// Size of what is compared as a whole.
const cv::Size kThumbnail(40, 30);  // Speed.
/// Every n-th pixel tells how much of one frame another one shows.
constexpr int kOverlapStride = 16;  // Speed.

/// The image as a whole: one row, mean 0, length 1.
cv::Mat_<float> ThumbnailOf(const LiveView& live) {
  cv::Mat small;
  cv::cvtColor(live.color, small, cv::COLOR_BGR2GRAY);
  cv::resize(small, small, kThumbnail, 0, 0, cv::INTER_AREA);
  cv::Mat_<float> row;
  small.reshape(1, 1).convertTo(row, CV_32F);
  row -= cv::mean(row)[0];
  return row / std::max(1.0, cv::norm(row));
}

/// Depth of the certain pixels of the background, metres; else 0.
cv::Mat_<float> CoarseDepth(const LiveView& live) {
  cv::Mat_<float> depth(live.depth.rows / kOverlapStride,
                        live.depth.cols / kOverlapStride, 0.f);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const int row = v * kOverlapStride, column = u * kOverlapStride;
      if (IsCertain(live, kBackground, row, column)) {
        depth(v, u) = live.depth(row, column);
      }
    }
  }
  return depth;
}

/// Share of the points of `depth` that another frame, in which things go by
/// `motion`, shows, too.
double SeenShare(const cv::Mat_<float>& depth, const Rigid3d& motion,
                 const cv::Mat_<float>& other, const PinholeCamera& camera) {
  int points = 0, seen = 0;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      if (!(depth(v, u) > 0)) continue;
      ++points;
      const Eigen::Vector3d point =
          motion * camera.BackProject<double>(u * kOverlapStride,
                                              v * kOverlapStride, depth(v, u));
      const auto pixel = camera.PixelOf(point.cast<float>());
      if (!pixel) continue;
      const int row = std::min(pixel->y() / kOverlapStride, other.rows - 1);
      const int column = std::min(pixel->x() / kOverlapStride, other.cols - 1);
      const double z = point.z();
      seen += ClassifyDepth<double>(other(row, column), z,
                                    kOneBody.At(z, camera.noise)) ==
              DepthState::kObserved;
    }
  }
  return points > 0 ? static_cast<double>(seen) / points : 1;
}

/// What a frame shows of the background, coarsely, and the same behind the
/// camera: turns and shifts of the camera then weigh apart. (Before it alone a
/// shift can undo a turn almost, and a camera that turned would be moved.)
TypicalPoints PointsShown(const cv::Mat_<float>& depth,
                          const PinholeCamera& camera) {
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      if (!(depth(v, u) > 0)) continue;
      const Eigen::Vector3f point = camera.BackProject<float>(
          u * kOverlapStride, v * kOverlapStride, depth(v, u));
      points.insert(points.end(), {point, -point});
    }
  }
  return TypicalPointsOf(points);
}

}  // namespace

void KeyFrameOptions::List(OptionList* list) {
  list->Number("overlap", &overlap, Range::Share(), "",
               "A frame is a key frame if every other one shows less than this "
               "share of what it shows; 0: there are none.");
  list->Number("landmarks", &landmarks, Range::AtLeast(4), "features",
               "Of a key frame, at most.");
  list->Number(
      "agreeing", &agreeing, Range::AtLeast(4), "features",
      "A lost camera may be where so many landmarks agree that it is.");
  list->Number("candidates", &candidates, Range::AtLeast(1), "",
               "Key frames that a lost camera's image is compared with by "
               "features.");
  list->Number("ratio", &ratio, Range::Share(), "",
               "Features match if the angle to the most similar one is below "
               "this fraction of that to the second.");
}

void KeyFrames::Keep(const LiveView& live, const Rigid3d& camera_from_world) {
  std::optional<Sight> sight = SightOf(kBackground, live);
  if (options_.overlap == 0 || !sight) return;
  latest_ = std::move(*sight);
  latest_pose_ = camera_from_world.matrix();
  const cv::Mat_<float> depth = CoarseDepth(live);
  // The latest are the likeliest to show the same.
  const bool known = std::any_of(
      key_frames_.rbegin(), key_frames_.rend(), [&](const KeyFrame& other) {
        const Rigid3d motion =
            Rigid3d(other.pose) * camera_from_world.inverse();
        return SeenShare(depth, motion, other.depth, live.camera) >=
               options_.overlap;
      });
  if (known) return;
  key_frames_.push_back({LandmarksOf(latest_, live.camera, options_.landmarks),
                         ThumbnailOf(live), depth, latest_pose_});
}

void KeyFrames::KeepOnPath(const LiveView& live,
                           const Rigid3d& camera_from_world, int frame,
                           bool goes_on) {
  const std::optional<Sight> sight = SightOf(kBackground, live);
  if (options_.overlap == 0 || !sight) return;
  const bool known = latest_on_path_.frame >= 0;
  // Where the camera was last before it was lost.
  if (known && !goes_on && latest_on_path_.frame != last_on_path_.frame) {
    AddToPath(LatestOnPath(live.camera));
  }
  PathFrame now;
  now.frame = frame;
  now.goes_on = known && goes_on;
  now.view.thumbnail = ThumbnailOf(live);
  now.view.depth = CoarseDepth(live);
  now.view.pose = camera_from_world.matrix();
  now.points = PointsShown(now.view.depth, live.camera);
  latest_on_path_ = now;
  if (now.goes_on) {
    const KeyFrame& before = last_on_path_.view;
    const Rigid3d motion = Rigid3d(before.pose) * camera_from_world.inverse();
    if (SeenShare(now.view.depth, motion, before.depth, live.camera) >=
        options_.overlap) {
      return;
    }
  }
  now.view.landmarks = LandmarksOf(*sight, live.camera, options_.landmarks);
  AddToPath(std::move(now));
}

void KeyFrames::AddToPath(PathFrame frame) {
  path_.Add(frame);
  frame.view.landmarks = {};
  last_on_path_ = std::move(frame);
}

PathFrame KeyFrames::LatestOnPath(const PinholeCamera& camera) const {
  PathFrame latest = latest_on_path_;
  latest.view.landmarks = LandmarksOf(latest_, camera, options_.landmarks);
  return latest;
}

std::vector<PathFrame> KeyFrames::Path(const PinholeCamera& camera) const {
  std::vector<PathFrame> path;
  for (int i = 0; i < path_.size(); ++i) path.push_back(path_.At(i));
  if (!path.empty() && latest_on_path_.frame != path.back().frame) {
    path.push_back(LatestOnPath(camera));
  }
  return path;
}

std::vector<const KeyFrame*> KeyFrames::MostAlike(const LiveView& live) const {
  const cv::Mat_<float> thumbnail = ThumbnailOf(live);
  std::vector<std::pair<double, const KeyFrame*>> alike;
  for (const KeyFrame& other : key_frames_) {
    alike.emplace_back(-thumbnail.dot(other.thumbnail), &other);
  }
  std::sort(alike.begin(), alike.end());
  std::vector<const KeyFrame*> best;
  for (const auto& [unlike, other] : alike) {
    if (static_cast<int>(best.size()) < options_.candidates) {
      best.push_back(other);
    }
  }
  return best;
}

std::vector<Rigid3d> KeyFrames::Find(const LiveView& live) const {
  const std::optional<Sight> sight = SightOf(kBackground, live);
  if (latest_.grey.empty() || !sight) return {};
  const Landmarks now = LandmarksOf(*sight, live.camera, options_.landmarks);
  std::vector<std::pair<int, Rigid3d>> found;
  const auto compare = [&](const Landmarks& before,
                           const Eigen::Matrix4d& pose) {
    const auto motion =
        FindLandmarkMotion(before, now, live.camera.noise, options_.ratio);
    if (motion && motion->points >= options_.agreeing)
      found.emplace_back(motion->points, motion->motion * Rigid3d(pose));
  };
  compare(LandmarksOf(latest_, live.camera, options_.landmarks), latest_pose_);
  for (const KeyFrame* other : MostAlike(live)) {
    compare(other->landmarks, other->pose);
  }
  std::stable_sort(
      found.begin(), found.end(),
      [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Rigid3d> places;
  for (const auto& [points, place] : found) places.push_back(place);
  return places;
}

}  // namespace splitfusion
