#include "splitfusion/lib/split/assignment.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/split/hungarian.h"

namespace splitfusion {
namespace {

/// Fewer predicted and not occluded pixels than this share of a detection tell
/// nothing of it.
constexpr double kMinPredicted = 0.1;

double Limited(double ratio, const AssignmentOptions& options) {
  return std::clamp(ratio, -options.limit, options.limit);
}

/// Of equal independent normal deviations against a uniform place in the room.
double PlaceRatio(double distance, int frames,
                  const AssignmentOptions& options) {
  const double sigma = options.PlaceDeviation(frames);
  const double deviation = distance / sigma;
  return Limited(
      3 * std::log(options.room / sigma) - 0.5 * deviation * deviation,
      options);
}

double AppearanceRatio(const Appearance& detected, const Appearance& known,
                       int frames, const AssignmentOptions& options) {
  if (detected.histogram.empty() || known.histogram.empty()) return 0;
  const double more = ColorSimilarity(detected, known) - options.equal_color;
  double ratio = Limited(options.color_slope * more, options);
  if (detected.placed && known.placed) {
    ratio +=
        PlaceRatio((detected.center - known.center).norm(), frames, options);
  }
  return ratio;
}

double IouRatio(double iou, const AssignmentOptions& options) {
  return Limited(options.iou_slope * (iou - options.equal_iou), options);
}

/// Pixels that a mask has in common with one surface.
struct CommonPixels {
  int all = 0;
  int measured = 0;  // With live depth.
  int same = 0;      // At the surface's depth.
  int occluded = 0;  // Behind something nearer.
};

/// Common pixels by surface id; `detected` receives the size of the mask.
std::map<int, CommonPixels> CountCommon(const cv::Mat_<uchar>& mask,
                                        const LabelImage& labels,
                                        const cv::Mat_<uchar>& agreement,
                                        int* detected) {
  std::map<int, CommonPixels> counts;
  // Neighbours mostly share their label: look up once per run.
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
      count->occluded += state == DepthState::kOccluded;
    }
  }
  return counts;
}

/// `visible`: predicted pixels that nothing nearer occludes.
Overlap MakeOverlap(int detected, int visible, const CommonPixels& common) {
  Overlap overlap;
  if (common.all == 0) return overlap;
  const int elsewhere = common.measured - common.same;
  overlap.iou = double(common.all - elsewhere) /
                (detected + visible - (common.all - common.occluded));
  if (common.measured > 0) {
    overlap.contained =
        double(common.same) / common.measured * common.all / detected;
  }
  return overlap;
}

double MaskIou(const cv::Mat& a, const cv::Mat& b) {
  const int common = cv::countNonZero(a & b);
  return common == 0 ? 0.0 : double(common) / cv::countNonZero(a | b);
}

/// Gains and overlaps of one candidate.
class Comparison {
 public:
  Comparison(const Candidate& candidate, const KnownSurfaces& known,
             const std::map<int, int>& visible,
             const AssignmentOptions& options)
      : candidate_(candidate),
        known_(known),
        visible_(visible),
        options_(options) {
    common_ = CountCommon(candidate.mask, known.predicted_labels,
                          known.agreement, &detected_);
  }

  Overlap OverlapWith(int id) const {
    const auto common = common_.find(id);
    if (common == common_.end()) return {};
    return MakeOverlap(detected_, visible_.at(id), common->second);
  }

  double GainOf(const Track& track) const {
    if (Identity() > 0) return Identity() == track.appearance.identity;
    const double iou = OverlapWith(track.id).iou;
    const double overlap = IouRatio(iou, options_);
    // Place tells nothing of these: a chair beside a person is where he is.
    if (!MayBe(track)) return overlap - options_.untrusted;
    const double gain =
        AppearanceRatio(candidate_.appearance, track.appearance,
                        known_.frame - track.last_detected_frame, options_);
    const auto visible = visible_.find(track.id);
    const bool expected = visible != visible_.end() &&
                          visible->second > kMinPredicted * detected_;
    if (!expected) return gain;
    // Where a track that is not tracked lies is a guess.
    return track.state == TrackState::kTracked ? gain + overlap
                                               : gain + std::max(0.0, overlap);
  }

  double GainOf(const TentativeTrack& track) const {
    if (Identity() > 0) return Identity() == track.appearance.identity;
    const double overlap =
        IouRatio(MaskIou(candidate_.mask, track.mask), options_);
    // What is alike and near may be another one: chairs stand side by side.
    if (track.moves) return overlap;
    return overlap + AppearanceRatio(candidate_.appearance, track.appearance,
                                     known_.frame - track.frame, options_);
  }

  /// The surface that it is a piece of; 0 if none.
  int Whole() const {
    if (Identity() > 0) return 0;
    int whole = 0;
    double best = options_.min_contained;
    for (const auto& [id, common] : common_) {
      const auto track = known_.tracks.find(id);
      if (track == known_.tracks.end() || !MayBe(track->second)) continue;
      const double contained = OverlapWith(id).contained;
      if (contained < best) continue;
      best = contained;
      whole = id;
    }
    return whole;
  }

 private:
  int Identity() const { return candidate_.appearance.identity; }

  bool MayBe(const Track& track) const {
    return candidate_.trusted ||
           (candidate_.apart && track.kind == SurfaceKind::kRigid);
  }

  const Candidate& candidate_;
  const KnownSurfaces& known_;
  const std::map<int, int>& visible_;  // Predicted pixels by id.
  const AssignmentOptions& options_;
  std::map<int, CommonPixels> common_;
  int detected_ = 0;
};

/// Predicted pixels that nothing nearer occludes, by surface id.
std::map<int, int> CountVisible(const LabelImage& labels,
                                const cv::Mat_<uchar>& agreement) {
  std::map<int, int> counts;
  int label = -1;
  int* count = nullptr;
  for (int v = 0; v < labels.rows; ++v) {
    for (int u = 0; u < labels.cols; ++u) {
      if (labels(v, u) != label) count = &counts[label = labels(v, u)];
      *count +=
          static_cast<DepthState>(agreement(v, u)) != DepthState::kOccluded;
    }
  }
  return counts;
}

}  // namespace

Overlap ComputeOverlap(const cv::Mat_<uchar>& mask, int surface,
                       const LabelImage& predicted_labels,
                       const cv::Mat_<uchar>& agreement) {
  int detected = 0;
  const auto counts = CountCommon(mask, predicted_labels, agreement, &detected);
  const auto found = counts.find(surface);
  if (found == counts.end()) return {};
  return MakeOverlap(detected,
                     CountVisible(predicted_labels, agreement).at(surface),
                     found->second);
}

int FindReturned(const Track& track, const TrackTable& tracks, int frame,
                 const AssignmentOptions& options) {
  if (track.appearance.identity > 0) return 0;  // It is known who it is.
  int returned = 0;
  double best = 0;
  for (const auto& [id, other] : tracks) {
    if (other.state == TrackState::kTracked || other.merged_into > 0 ||
        other.kind != track.kind ||
        other.last_detected_frame >= track.first_frame ||
        other.appearance.pixels < track.appearance.pixels) {
      continue;
    }
    const double ratio =
        AppearanceRatio(track.appearance, other.appearance,
                        frame - other.last_detected_frame, options);
    if (ratio <= best) continue;
    best = ratio;
    returned = id;
  }
  return returned;
}

std::vector<Match> AssignDetections(const std::vector<Candidate>& candidates,
                                    const KnownSurfaces& known,
                                    const AssignmentOptions& options) {
  const std::map<int, int> visible =
      CountVisible(known.predicted_labels, known.agreement);
  const int surfaces = static_cast<int>(known.tracks.size());
  cv::Mat_<double> gains(static_cast<int>(candidates.size()),
                         surfaces + static_cast<int>(known.tentative.size()));
  std::vector<Comparison> comparisons;
  for (const Candidate& candidate : candidates) {
    double* gain = gains[static_cast<int>(comparisons.size())];
    const Comparison& comparison =
        comparisons.emplace_back(candidate, known, visible, options);
    for (const auto& [id, track] : known.tracks) {
      *gain++ = track.merged_into > 0 ? 0 : comparison.GainOf(track);
    }
    for (const TentativeTrack& track : known.tentative) {
      *gain++ = comparison.GainOf(track);
    }
  }
  std::vector<int> ids;
  for (const auto& [id, track] : known.tracks) ids.push_back(id);
  const std::vector<int> columns = AssignRows(gains);
  std::vector<Match> matches(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Match& match = matches[i];
    if (columns[i] >= surfaces) match.tentative = columns[i] - surfaces;
    if (columns[i] >= 0 && columns[i] < surfaces) {
      match.surface = ids[columns[i]];
    } else {
      match.surface = comparisons[i].Whole();
      match.piece = match.surface > 0;
    }
    if (match.surface > 0) {
      match.iou = comparisons[i].OverlapWith(match.surface).iou;
    }
  }
  return matches;
}

}  // namespace splitfusion
