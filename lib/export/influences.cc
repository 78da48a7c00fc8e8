#include "splitfusion/lib/export/influences.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace splitfusion {
namespace {

Skinning SortedByWeight(const Skinning& skinning, int count) {
  std::vector<std::pair<float, std::int32_t>> order;
  for (int k = 0; k < skinning.count; ++k) {
    order.emplace_back(skinning.weights[k], skinning.nodes[k]);
  }
  std::stable_sort(
      order.begin(), order.end(),
      [](const auto& a, const auto& b) { return a.first > b.first; });
  order.resize(std::min<std::size_t>(order.size(), count));
  double sum = 0;
  for (const auto& [weight, node] : order) sum += weight;
  Skinning sorted;
  for (const auto& [weight, node] : order) {
    sorted.nodes[sorted.count] = node;
    sorted.weights[sorted.count++] = static_cast<float>(weight / sum);
  }
  return sorted;
}

}  // namespace

std::vector<Skinning> HeaviestFirst(const std::vector<Skinning>& skinning,
                                    int count) {
  std::vector<Skinning> sorted;
  sorted.reserve(skinning.size());
  for (const Skinning& one : skinning) {
    sorted.push_back(SortedByWeight(one, count));
  }
  return sorted;
}

double InfluenceError::RootMeanSquare() const {
  return vertices > 0 ? std::sqrt(sum_of_squares / vertices) : 0;
}

InfluenceError& InfluenceError::operator+=(const InfluenceError& other) {
  sum_of_squares += other.sum_of_squares;
  vertices += other.vertices;
  largest = std::max(largest, other.largest);
  return *this;
}

InfluenceError ErrorOf(const ExportSurface& surface,
                       const std::vector<Skinning>& by) {
  InfluenceError error;
  for (const ExportMoment& moment : surface.moments) {
    const auto own = surface.VerticesAt(moment, surface.skinning);
    const auto other = surface.VerticesAt(moment, by);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const double distance = (own[i] - other[i]).norm();
      error.sum_of_squares += distance * distance;
      error.largest = std::max(error.largest, distance);
    }
    error.vertices += static_cast<double>(own.size());
  }
  return error;
}

}  // namespace splitfusion
