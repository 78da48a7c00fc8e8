#include "splitfusion/lib/model/refuted_parts.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {

DepthState LookAt(const LiveView& live, int surface,
                  const Eigen::Vector3f& point,
                  const DepthTolerance<float>& tolerance) {
  const auto pixel = live.camera.PixelOf(point);
  if (!pixel) return DepthState::kUnmeasured;
  const int u = pixel->x(), v = pixel->y();
  if (live.uncertain(v, u) != 0 || live.edges(v, u) != 0) {
    return DepthState::kUnmeasured;
  }
  const float depth = live.depth(v, u);
  const DepthState state =
      ClassifyDepth(depth, point.z(), tolerance.At(depth, live.camera.noise));
  return state == DepthState::kObserved && live.labels(v, u) != surface
             ? DepthState::kUnmeasured
             : state;
}

void RefutedParts::Look(const LiveView& live, int surface,
                        const std::vector<Eigen::Vector3f>& warped,
                        const std::vector<Skinning>& skinning, int nodes,
                        double truncation) {
  const DepthTolerance<float> tolerance{static_cast<float>(truncation)};
  std::vector<DepthState> states(warped.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, warped.size(), 4096),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end();
                           ++i) {
                        states[i] = LookAt(live, surface, warped[i], tolerance);
                      }
                    });
  std::vector<float> free(nodes, 0), there(nodes, 0);
  std::vector<char> carries(nodes, false);
  for (std::size_t i = 0; i < warped.size(); ++i) {
    const Skinning& carried = skinning[i];
    for (int k = 0; k < carried.count; ++k) carries[carried.nodes[k]] = true;
    const bool is_free = states[i] == DepthState::kFree;
    if (!is_free && states[i] != DepthState::kObserved) continue;
    std::vector<float>& votes = is_free ? free : there;
    for (int k = 0; k < carried.count; ++k) {
      votes[carried.nodes[k]] += carried.weights[k];
    }
  }
  frames_.resize(nodes, 0);
  for (int i = 0; i < nodes; ++i) {
    if (free[i] > there[i]) {
      ++frames_[i];
    } else if (there[i] > 0 || carries[i] == 0) {
      frames_[i] = 0;
    }
  }
}

std::vector<char> RefutedParts::Nodes(int frames, int end) const {
  std::vector<char> nodes(frames_.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i] = frames_[i] >= frames && frames_[i] < end;
  }
  return nodes;
}

void RefutedParts::Forget(const std::vector<char>& nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] != 0) frames_[i] = 0;
  }
}

}  // namespace splitfusion
