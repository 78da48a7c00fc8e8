#include "splitfusion/lib/split/instance_matcher.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/split/surface_prior.h"

namespace splitfusion {
namespace {

using OverlapTable = std::vector<std::map<int, Overlap>>;  // [detection][id]

/// Pixels that a mask has in common with one surface.
struct CommonPixels {
  int all = 0;
  int measured = 0;  // With live depth.
  int same = 0;      // At the surface's depth.
};

/// Pixels of every surface in the projection, by id.
std::map<int, int> CountPredicted(const LabelImage& labels) {
  std::map<int, int> counts;
  // Neighbours mostly share their label: look up once per run.
  int label = -1;
  int* count = nullptr;
  for (const std::uint16_t value : labels) {
    if (value != label) count = &counts[label = value];
    ++*count;
  }
  return counts;
}

/// Common pixels by surface id; `detected` receives the size of the mask.
std::map<int, CommonPixels> CountCommon(const cv::Mat_<uchar>& mask,
                                        const LabelImage& labels,
                                        const cv::Mat_<uchar>& agreement,
                                        int* detected) {
  std::map<int, CommonPixels> counts;
  int label = -1;
  CommonPixels* count = nullptr;
  *detected = 0;
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      if (!mask(v, u)) continue;
      ++*detected;
      if (labels(v, u) != label) count = &counts[label = labels(v, u)];
      const auto state = static_cast<DepthState>(agreement(v, u));
      ++count->all;
      count->measured += state != DepthState::kUnmeasured;
      count->same += state == DepthState::kObserved;
    }
  }
  return counts;
}

Overlap MakeOverlap(int detected, int predicted, const CommonPixels& common) {
  Overlap overlap;
  if (common.all == 0) return overlap;
  overlap.iou = double(common.all) / (detected + predicted - common.all);
  overlap.covered = double(common.all) / predicted;
  overlap.agreement =
      common.measured > 0 ? double(common.same) / common.measured : 0;
  overlap.contained = overlap.agreement * common.all / detected;
  return overlap;
}

OverlapTable ComputeTable(const std::vector<Candidate>& candidates,
                          const LabelImage& labels,
                          const cv::Mat_<uchar>& agreement,
                          const std::set<int>& surfaces) {
  const std::map<int, int> predicted = CountPredicted(labels);
  OverlapTable table;
  for (const Candidate& candidate : candidates) {
    std::map<int, Overlap>& row = table.emplace_back();
    int detected = 0;
    const auto counts =
        CountCommon(candidate.mask, labels, agreement, &detected);
    for (const auto& [id, common] : counts) {
      if (surfaces.count(id) == 0) continue;
      row[id] = MakeOverlap(detected, predicted.at(id), common);
    }
  }
  return table;
}

bool MayMatch(const Overlap& overlap, Trust trust,
              const MatchOptions& options) {
  if (overlap.agreement < options.min_agreement) return false;
  if (trust == Trust::kMatched) return overlap.iou >= options.min_iou_matched;
  return overlap.iou >= options.min_iou ||
         overlap.covered >= options.min_contained;
}

/// One to one, largest IoU first; ties by detection, then by id.
void MatchOneToOne(const OverlapTable& table,
                   const std::vector<Candidate>& candidates,
                   const MatchOptions& options, std::vector<Match>* matches) {
  std::vector<std::tuple<double, int, int>> pairs;
  for (int d = 0; d < static_cast<int>(table.size()); ++d) {
    for (const auto& [id, overlap] : table[d]) {
      if (MayMatch(overlap, candidates[d].trust, options)) {
        pairs.emplace_back(-overlap.iou, d, id);
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::set<int> taken;
  for (const auto& [negative_iou, d, id] : pairs) {
    if ((*matches)[d].surface > 0 || !taken.insert(id).second) continue;
    (*matches)[d] = {id, -negative_iou, false};
  }
}

void MatchPieces(const OverlapTable& table,
                 const std::vector<Candidate>& candidates,
                 const MatchOptions& options, std::vector<Match>* matches) {
  for (std::size_t d = 0; d < table.size(); ++d) {
    Match& match = (*matches)[d];
    if (match.surface > 0 || candidates[d].trust != Trust::kFull) continue;
    double best = options.min_contained;
    for (const auto& [id, overlap] : table[d]) {
      if (overlap.contained < best) continue;
      best = overlap.contained;
      match = {id, overlap.iou, true};
    }
  }
}

}  // namespace

void MatchOptions::Check() const {
  const auto check_share = [](const std::string& field, double value) {
    CheckOption(value > 0 && value <= 1, field, value, "0..1, not 0");
  };
  check_share("min_iou", min_iou);
  check_share("min_iou_matched", min_iou_matched);
  check_share("min_contained", min_contained);
  CheckOption(min_agreement >= 0 && min_agreement <= 1, "min_agreement",
              min_agreement, "0..1");
}

Overlap ComputeOverlap(const cv::Mat_<uchar>& mask, int surface,
                       const LabelImage& predicted_labels,
                       const cv::Mat_<uchar>& agreement) {
  int detected = 0;
  const auto counts = CountCommon(mask, predicted_labels, agreement, &detected);
  const auto found = counts.find(surface);
  if (found == counts.end()) return {};
  return MakeOverlap(detected, cv::countNonZero(predicted_labels == surface),
                     found->second);
}

std::vector<Match> MatchInstances(const std::vector<Candidate>& candidates,
                                  const LabelImage& predicted_labels,
                                  const cv::Mat_<uchar>& agreement,
                                  const std::set<int>& surfaces,
                                  const MatchOptions& options) {
  std::vector<Match> matches(candidates.size());
  const OverlapTable table =
      ComputeTable(candidates, predicted_labels, agreement, surfaces);
  MatchOneToOne(table, candidates, options, &matches);
  MatchPieces(table, candidates, options, &matches);
  return matches;
}

}  // namespace splitfusion
