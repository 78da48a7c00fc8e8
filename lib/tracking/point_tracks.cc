#include "splitfusion/lib/tracking/point_tracks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "splitfusion/lib/geometry/nearest_point.h"
#include "splitfusion/lib/tracking/agreement.h"
#include "splitfusion/lib/tracking/dense_flow.h"

namespace splitfusion {
namespace {

/// Around what moves, pixels: two of the patches of eight that DenseFlow
/// compares, so that its border does not end within one.
constexpr int kMargin = 16;

/// The part of the image in which the tracks of a surface are, and the surface
/// in the next one.
cv::Rect BoxOf(const std::vector<PointTrack>& tracks, int surface,
               const cv::Mat_<std::uint16_t>& labels) {
  cv::Rect box = cv::boundingRect(labels == surface);
  for (const PointTrack& track : tracks) {
    box |= cv::Rect(static_cast<int>(track.pixel.x()),
                    static_cast<int>(track.pixel.y()), 1, 1);
  }
  box -= cv::Point(kMargin, kMargin);
  box += cv::Size(2 * kMargin, 2 * kMargin);
  return box & cv::Rect({}, labels.size());
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
  list->Number(
      "track_max_return", &max_return, Range::Above(0), "pixels",
      "A track ends where optical flow there and back is farther off.");
}

void PointTracks::Follow(const LiveView& live, const std::set<int>& surfaces) {
  cv::Mat_<std::uint8_t> grey;
  cv::cvtColor(live.color, grey, cv::COLOR_BGR2GRAY);
  cv::Mat_<cv::Vec2f> flow(grey.size(), cv::Vec2f(0, 0));
  std::map<int, std::vector<PointTrack>> followed;
  flows_.clear();
  for (const int surface : surfaces) {
    std::vector<PointTrack>& kept = followed[surface];
    const auto known = tracks_.find(surface);
    if (known == tracks_.end() || known->second.empty()) continue;
    const DenseFlow& moved =
        flows_
            .emplace(
                surface,
                DenseFlow(grey_, grey,
                          BoxOf(known->second, surface, live.labels), flow_))
            .first->second;
    moved.Write(&flow);
    for (const PointTrack& track : known->second) {
      const auto place =
          moved.Follow({track.pixel.x(), track.pixel.y()}, options_.max_return);
      if (!place) continue;
      const Eigen::Vector2f there(place->x, place->y);
      const auto pixel = live.camera.PixelAt(there);
      if (!pixel || !IsCertain(live, surface, pixel->y(), pixel->x())) continue;
      kept.push_back({track.point, there});
    }
  }
  tracks_ = std::move(followed);
  grey_ = grey;
  flow_ = flow;
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
    point.weight = live.camera.noise.Confidence(z);
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
    const float deviation =
        std::abs(z - point.z()) * std::sqrt(live.camera.noise.Confidence(z));
    if (place != 0 || deviation > kAgreeingDistance / 2) {
      continue;
    }
    place = 1;
    tracks.push_back({sample.point, live.camera.Project(point)});
  }
}

}  // namespace splitfusion
