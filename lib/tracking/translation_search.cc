#include "splitfusion/lib/tracking/translation_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "splitfusion/lib/base/median.h"
#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/tracking/agreement.h"

namespace splitfusion {
namespace {

constexpr int kColumns = 80;  // Of the grid of pixels that is searched.
/// Farther from or nearer to the camera by more, metres, a surface would look
/// larger or smaller.
constexpr float kMaxDepthChange = 0.4f;
/// What a pixel of the silhouette counts, as a part of a point that agrees.
constexpr float kSilhouette = 0.5f;
/// Changes of depth that are told apart, to either side.
constexpr int kBins = static_cast<int>(kMaxDepthChange / kAgreeingDistance);

/// What is seen in one cell of the grid.
struct Cell {
  int u = 0;        ///< Column of the grid.
  int v = 0;        ///< Row of the grid.
  float depth = 0;  ///< Metres, 0 = nothing.
  float grey = 0;   ///< Coarse grey value, 0..1.
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< Camera frame.
};

std::vector<Cell> ModelCells(const std::vector<ModelSample>& samples,
                             const WarpField& warp, int step) {
  std::vector<Cell> cells;
  for (const ModelSample& sample : samples) {
    if (sample.u % step != 0 || sample.v % step != 0) continue;
    cells.push_back({sample.u / step, sample.v / step,
                     warp.WarpPoint(sample.skinning, sample.point).z(),
                     sample.intensity[1],
                     warp.WarpNormal(sample.skinning, sample.normal)});
  }
  return cells;
}

/// The smallest rectangle of the grid with all cells, of which there are some.
cv::Rect BoundsOf(const std::vector<Cell>& cells) {
  cv::Rect bounds(cells.front().u, cells.front().v, 1, 1);
  for (const Cell& cell : cells) bounds |= cv::Rect(cell.u, cell.v, 1, 1);
  return bounds;
}

float MedianDepth(const std::vector<Cell>& cells) {
  std::vector<float> depths;
  for (const Cell& cell : cells) depths.push_back(cell.depth);
  return Median(std::move(depths));
}

/// The live frame on the grid.
struct LiveGrid {
  LiveGrid(const LiveView& live, std::uint16_t surface, int step)
      : own((live.depth.rows + step - 1) / step,
            (live.depth.cols + step - 1) / step, -1),
        depth(own.size()) {
    for (int v = 0; v < own.rows; ++v) {
      for (int u = 0; u < own.cols; ++u) {
        const cv::Point pixel(u * step, v * step);
        depth(v, u) = live.depth(pixel);
        if (live.labels(pixel) != surface || !(depth(v, u) > 0)) continue;
        own(v, u) = static_cast<int>(cells.size());
        cells.push_back({u, v, depth(v, u), live.grey[1].value(pixel),
                         ToEigen(live.map.normals(pixel))});
      }
    }
  }

  cv::Mat_<int> own;        ///< Index of the surface's cell; -1 = another's.
  cv::Mat_<float> depth;    ///< Metres, 0 = nothing.
  std::vector<Cell> cells;  ///< Of the surface.
};

/// How much speaks for a translation.
struct Vote {
  float worth = 0;         ///< In points that agree.
  float depth_change = 0;  ///< Metres along the optical axis.
};

/// How well two cells agree but for their depth: 0..1.
float Agreement(const Cell& a, const Cell& b) {
  return std::max(0.0f, a.normal.dot(b.normal)) *
         std::max(0.0f, 1 - std::abs(a.grey - b.grey) / kAgreeingGrey);
}

/// Of all changes of depth the best for this shift of the grid; `behind`: depth
/// of what lies behind the surface for sure.
Vote VoteFor(const cv::Point& shift, const std::vector<Cell>& model,
             const LiveGrid& live, float behind) {
  // One more on either side: the neighbours of every bin are counted, too.
  std::array<float, 2 * kBins + 3> agreeing{};
  int covered = 0;
  for (const Cell& cell : model) {
    const cv::Point place(cell.u + shift.x, cell.v + shift.y);
    if (!place.inside({0, 0, live.own.cols, live.own.rows})) continue;
    const int index = live.own(place);
    if (index < 0) {
      covered -= live.depth(place) > behind;
      continue;
    }
    ++covered;
    const Cell& seen = live.cells[index];
    const auto bin = std::lround((seen.depth - cell.depth) / kAgreeingDistance);
    if (std::abs(bin) <= kBins) {
      agreeing[bin + kBins + 1] += Agreement(cell, seen);
    }
  }
  Vote best;
  for (int bin = -kBins; bin <= kBins; ++bin) {
    const float* at = &agreeing[bin + kBins + 1];
    const float sum = at[-1] + at[0] + at[1];
    if (!(sum > best.worth)) continue;
    best = {sum, kAgreeingDistance *
                     (static_cast<float>(bin) + (at[1] - at[-1]) / sum)};
  }
  best.worth += kSilhouette * static_cast<float>(covered);
  return best;
}

/// The votes for all shifts of a model over the live frame.
class Votes {
 public:
  /// `step`: pixels of the live frame from cell to cell.
  Votes(const std::vector<Cell>& model, const LiveGrid& live,
        const PinholeCamera& camera, int step) {
    const float z = MedianDepth(live.cells);
    step_x_ = step * z / camera.fx;
    step_y_ = step * z / camera.fy;
    const cv::Rect from = BoundsOf(model), to = BoundsOf(live.cells);
    first_ = to.tl() - from.br() + cv::Point(1, 1);
    size_ = to.size() + from.size() - cv::Size(1, 1);
    votes_.reserve(size_.area());
    const float farthest = z + kOneBody.At(z, camera.noise);
    for (int y = 0; y < size_.height; ++y) {
      for (int x = 0; x < size_.width; ++x) {
        votes_.push_back(
            VoteFor(first_ + cv::Point(x, y), model, live, farthest));
      }
    }
  }

  /// Of the shifts that beat their neighbours the way, metres, for which most
  /// speaks, weighed by a normal deviation; none if nothing speaks for any.
  std::optional<Eigen::Vector3d> MostProbable(double deviation) const {
    std::optional<Eigen::Vector3d> best;
    double most = 0;
    for (int y = 0; y < size_.height; ++y) {
      for (int x = 0; x < size_.width; ++x) {
        const Vote& vote = At(x, y);
        if (!(vote.worth > most)) continue;  // Weighed, it is less.
        const Eigen::Vector3d way((first_.x + x) * step_x_,
                                  (first_.y + y) * step_y_, vote.depth_change);
        const double worth = vote.worth * std::exp(-0.5 * way.squaredNorm() /
                                                   (deviation * deviation));
        if (!(worth > most) || !IsPeak(x, y)) continue;
        most = worth;
        best = way;
      }
    }
    return best;
  }

 private:
  const Vote& At(int x, int y) const { return votes_[y * size_.width + x]; }

  bool IsPeak(int x, int y) const {
    for (int v = std::max(0, y - 1); v <= std::min(size_.height - 1, y + 1);
         ++v) {
      for (int u = std::max(0, x - 1); u <= std::min(size_.width - 1, x + 1);
           ++u) {
        if (At(u, v).worth > At(x, y).worth) return false;
      }
    }
    return true;
  }

  double step_x_, step_y_;  // From shift to shift, metres.
  cv::Point first_;         // Shift, cells.
  cv::Size size_;
  std::vector<Vote> votes_;  // By row and column.
};

}  // namespace

std::optional<Rigid3d> FindTranslation(const std::vector<ModelSample>& samples,
                                       const WarpField& warp,
                                       const LiveView& live,
                                       std::uint16_t surface,
                                       double deviation) {
  const int step = std::max(1, live.depth.cols / kColumns);
  const std::vector<Cell> model = ModelCells(samples, warp, step);
  const LiveGrid grid(live, surface, step);
  if (model.empty() || grid.cells.empty()) return std::nullopt;
  const auto way =
      Votes(model, grid, live.camera, step).MostProbable(deviation);
  if (!way) return std::nullopt;
  Rigid3d motion = Rigid3d::Identity();
  motion.translation() = *way;
  return motion;
}

}  // namespace splitfusion
