#include "splitfusion/lib/evaluation/mean_error.h"

#include <algorithm>

namespace splitfusion {
namespace {

template <std::size_t N>
std::array<double, N> Mean(const std::vector<std::array<double, N>>& items) {
  std::array<double, N> mean{};
  for (const auto& item : items) {
    for (std::size_t i = 0; i < N; ++i) {
      mean[i] += item[i] / static_cast<double>(items.size());
    }
  }
  return mean;
}

ErrorStatistics Mean(const std::vector<ErrorStatistics>& items) {
  ErrorStatistics mean;
  const auto count = static_cast<double>(items.size());
  for (const ErrorStatistics& item : items) {
    mean.count += item.count;
    mean.rmse += item.rmse / count;
    mean.mean += item.mean / count;
    mean.median += item.median / count;
    mean.p90 += item.p90 / count;
    mean.max = std::max(mean.max, item.max);
  }
  return mean;
}

/// One member of every item.
template <typename Item, typename Member>
std::vector<Member> All(const std::vector<Item>& items, Member Item::*member) {
  std::vector<Member> members;
  for (const Item& item : items) members.push_back(item.*member);
  return members;
}

}  // namespace

ErrorStatistics MeanOf(std::vector<ErrorStatistics> items) {
  items.erase(std::remove_if(
                  items.begin(), items.end(),
                  [](const ErrorStatistics& item) { return item.count == 0; }),
              items.end());
  return Mean(items);
}

SurfaceDistances MeanOf(const std::vector<SurfaceDistances>& items) {
  return {Mean(All(items, &SurfaceDistances::statistics)),
          Mean(All(items, &SurfaceDistances::within))};
}

SurfaceError MeanOf(const std::vector<SurfaceError>& items) {
  return {MeanOf(All(items, &SurfaceError::accuracy)),
          MeanOf(All(items, &SurfaceError::completeness)),
          Mean(All(items, &SurfaceError::f_score))};
}

InstanceMeans MeanOf(const InstanceError& instance) {
  InstanceMeans means;
  std::vector<SurfaceError> surfaces;
  std::vector<SurfaceError> shown;
  std::vector<SurfaceDistances> views;
  for (const InstanceFrameError& frame : instance.frames) {
    if (frame.matched) surfaces.push_back(frame.surface);
    if (frame.matched && !frame.missing) shown.push_back(frame.surface);
    means.frames_missing += frame.missing ? 1 : 0;
    if (frame.view.pixels == 0) continue;
    means.view.pixels += frame.view.pixels;
    means.view.uncovered += frame.view.uncovered;
    views.push_back(frame.view.distances);
  }
  means.surface_frames = static_cast<int>(surfaces.size());
  means.surface = MeanOf(surfaces);
  means.shown = MeanOf(shown);
  means.view_frames = static_cast<int>(views.size());
  means.view.distances = MeanOf(views);
  return means;
}

}  // namespace splitfusion
