#include "splitfusion/lib/split/instance_matcher.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/split/surface_prior.h"

namespace splitfusion {
namespace {

using OverlapTable = std::vector<std::map<int, Overlap>>;  // [detection][id]

OverlapTable ComputeTable(const std::vector<Candidate>& candidates,
                          const LabelImage& labels,
                          const cv::Mat_<uchar>& agreement,
                          const std::set<int>& surfaces) {
  OverlapTable table;
  for (const Candidate& candidate : candidates) {
    std::map<int, Overlap>& row = table.emplace_back();
    for (const int id : surfaces) {
      row[id] = ComputeOverlap(candidate.mask, id, labels, agreement);
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
  int detected = 0, predicted = 0, common = 0, same = 0, measured = 0;
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      const bool in_mask = mask(v, u) > 0;
      const bool in_surface = predicted_labels(v, u) == surface;
      detected += in_mask;
      predicted += in_surface;
      if (!in_mask || !in_surface) continue;
      ++common;
      const auto state = static_cast<Agreement>(agreement(v, u));
      same += state == Agreement::kSame;
      measured += state != Agreement::kUnknown;
    }
  }
  Overlap overlap;
  if (common == 0) return overlap;
  overlap.iou = double(common) / (detected + predicted - common);
  overlap.covered = double(common) / predicted;
  overlap.agreement = measured > 0 ? double(same) / measured : 0;
  overlap.contained = overlap.agreement * common / detected;
  return overlap;
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
