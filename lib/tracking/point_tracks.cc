#include "splitfusion/lib/tracking/point_tracks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <utility>

#include "splitfusion/lib/geometry/nearest_point.h"
#include "splitfusion/lib/tracking/agreement.h"

namespace splitfusion {
namespace {

/// Levels of the image pyramids above the image itself: with a window of 21
/// pixels a point may move by 80.
constexpr int kPyramidLevels = 3;

std::vector<cv::Point2f> PixelsOf(
    const std::map<int, std::vector<PointTrack>>& tracks) {
  std::vector<cv::Point2f> pixels;
  for (const auto& [surface, points] : tracks) {
    for (const PointTrack& track : points) {
      pixels.emplace_back(track.pixel.x(), track.pixel.y());
    }
  }
  return pixels;
}

/// Where points of one image are in another, and which were found.
struct SparseFlow {
  std::vector<cv::Point2f> pixels;
  std::vector<std::uint8_t> found;
};

SparseFlow FollowPixels(const cv::Mat& from, const cv::Mat& to,
                        const std::vector<cv::Point2f>& pixels, int window) {
  SparseFlow flow;
  if (pixels.empty()) return flow;
  cv::calcOpticalFlowPyrLK(from, to, pixels, flow.pixels, flow.found,
                           cv::noArray(), {window, window}, kPyramidLevels);
  return flow;
}

/// Model points by where they are in the canonical frame.
NearestPoint PlacesOf(const std::vector<ModelSample>& samples) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(samples.size());
  for (const ModelSample& sample : samples) points.push_back(sample.point);
  return NearestPoint(points);
}

}  // namespace

void PointTrackOptions::List(OptionList* list) {
  list->Number("track_spacing", &spacing, Range::AtLeast(0), "pixels",
               "Points of deforming surfaces are followed from image to image, "
               "for the term tracks, one in so many; 0: none.");
  list->Number("track_window", &window, {3, 101}, "pixels",
               "Of the image around such a point that is compared.");
  list->Number(
      "track_max_return", &max_return, Range::Above(0), "pixels",
      "A track ends where optical flow there and back is farther off.");
}

void PointTracks::Follow(const LiveView& live, const std::set<int>& surfaces) {
  cv::Mat_<std::uint8_t> grey;
  cv::cvtColor(live.color, grey, cv::COLOR_BGR2GRAY);
  const std::vector<cv::Point2f> start = PixelsOf(tracks_);
  const SparseFlow forth = FollowPixels(grey_, grey, start, options_.window);
  const SparseFlow back =
      FollowPixels(grey, grey_, forth.pixels, options_.window);
  std::map<int, std::vector<PointTrack>> followed;
  for (const int surface : surfaces) followed[surface];
  std::size_t i = 0;
  for (const auto& [surface, points] : tracks_) {
    const auto kept = followed.find(surface);
    for (const PointTrack& track : points) {
      const std::size_t at = i++;
      if (kept == followed.end() || !forth.found[at] || !back.found[at] ||
          cv::norm(back.pixels[at] - start[at]) > options_.max_return) {
        continue;
      }
      const Eigen::Vector2f place(forth.pixels[at].x, forth.pixels[at].y);
      const auto pixel = live.camera.PixelAt(place);
      if (!pixel || !IsCertain(live, surface, pixel->y(), pixel->x())) continue;
      kept->second.push_back({track.point, place});
    }
  }
  tracks_ = std::move(followed);
  grey_ = grey;
}

std::vector<TrackedPoint> PointTracks::Find(
    int surface, const std::vector<ModelSample>& samples,
    const SkinningIndex& index, const WarpField& warp, const LiveView& live,
    double max_change) const {
  std::vector<TrackedPoint> found;
  if (samples.empty() || Of(surface).empty()) return found;
  const NearestPoint places = PlacesOf(samples);
  int nearest = -1;
  for (const PointTrack& track : Of(surface)) {
    const Eigen::Vector2i pixel = *live.camera.PixelAt(track.pixel);
    const float z = live.depth(pixel.y(), pixel.x());
    float distance = 0;
    nearest = places.Find(track.point, nearest, &distance);
    if (distance > kAgreeingDistance) continue;
    TrackedPoint point;
    point.model = samples[nearest];
    point.model.point = track.point;
    point.model.skinning = index.Skin(track.point);
    if (std::abs(warp.WarpPoint(point.model.skinning, track.point).z() - z) >
        max_change) {
      continue;
    }
    point.target = live.camera.BackProject(track.pixel.x(), track.pixel.y(), z);
    point.weight = DepthConfidence(z);
    found.push_back(point);
  }
  return found;
}

void PointTracks::Begin(int surface, const std::vector<ModelSample>& samples,
                        const WarpField& warp, const LiveView& live) {
  const int cell = options_.spacing;
  cv::Mat_<std::uint8_t> taken(live.camera.height / cell + 1,
                               live.camera.width / cell + 1, std::uint8_t{0});
  std::vector<PointTrack>& tracks = tracks_.at(surface);
  for (const PointTrack& track : tracks) {
    const Eigen::Vector2i pixel = *live.camera.PixelAt(track.pixel);
    taken(pixel.y() / cell, pixel.x() / cell) = 1;
  }
  for (const ModelSample& sample : samples) {
    const Eigen::Vector3f point = warp.WarpPoint(sample.skinning, sample.point);
    const auto pixel = live.camera.PixelOf(point);
    if (!pixel || !IsCertain(live, surface, pixel->y(), pixel->x())) continue;
    std::uint8_t& place = taken(pixel->y() / cell, pixel->x() / cell);
    const float z = live.depth(pixel->y(), pixel->x());
    if (place != 0 || std::abs(z - point.z()) * std::sqrt(DepthConfidence(z)) >
                          kAgreeingDistance / 2) {
      continue;
    }
    place = 1;
    tracks.push_back({sample.point, live.camera.Project(point)});
  }
}

}  // namespace splitfusion
