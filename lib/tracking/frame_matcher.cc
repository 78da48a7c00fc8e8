#include "splitfusion/lib/tracking/frame_matcher.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

namespace splitfusion {
namespace {

constexpr std::uint16_t kNone = 0xffff;  // Layout.

/// Flow that differs more from a feature within that is wrong, pixels.
constexpr double kAgreeing = 3;
cv::Rect Around(cv::Rect box, int margin, const cv::Size& size) {
  box -= cv::Point(margin, margin);
  box += cv::Size(2 * margin, 2 * margin);
  return box & cv::Rect({}, size);
}

/// Flow but for what features beside it contradict, and the features.
std::vector<PixelMatch> WithFeatures(const std::vector<PixelMatch>& flow,
                                     const std::vector<PixelMatch>& features) {
  std::vector<PixelMatch> matches;
  for (const PixelMatch& match : flow) {
    const PixelMatch* nearest = nullptr;
    double distance = kWindowMargin;
    for (const PixelMatch& feature : features) {
      const double away = cv::norm(feature.from - match.from);
      if (away < distance) distance = away, nearest = &feature;
    }
    if (nearest == nullptr || cv::norm((nearest->to - nearest->from) -
                                       (match.to - match.from)) <= kAgreeing) {
      matches.push_back(match);
    }
  }
  matches.insert(matches.end(), features.begin(), features.end());
  return matches;
}

}  // namespace

void MatchOptions::List(OptionList* list) {
  list->Number("match_spacing", &spacing, Range::AtLeast(1), "pixels",
               "For parts, points of deforming surfaces are matched from image "
               "to image by flow, one in so many columns and rows.");
  list->Number("match_max_return", &max_return, Range::Above(0), "pixels",
               "They are not matched where optical flow there and back is "
               "farther off.");
  list->Switch("match_features", &features,
               "Where flow is often lost, features are matched as well.");
  list->Text("feature_model", &feature_model,
             "ONNX file of XFeat, whose features these are then; empty: those "
             "of SIFT.");
  list->Number("feature_min_score", &min_score, Range::Share(), "",
               "Features of that network are at least so probable.");
  list->Number("feature_min_cosine", &min_cosine, {-1, 1}, "",
               "They are matched if the cosine of the angle between them is at "
               "least this.");
  list->Number("match_lost_share", &lost_share, Range::Share(), "",
               "That is where it lost a larger share of the points nearby.");
  list->Number("match_reach", &reach, Range::AtLeast(0), "pixels",
               "How far features are looked for.");
  list->Number(
      "match_ratio", &ratio, Range::Share(), "",
      "A feature of SIFT is matched if the angle to the most similar one is "
      "below this fraction of that to the second.");
}

FrameMatcher::FrameMatcher(MatchOptions options)
    : options_(std::move(options)) {
  if (options_.feature_model.empty()) return;
  network_ = std::make_unique<FeatureNetwork>(options_.feature_model);
}

void FrameMatcher::Begin(const LiveView& live) {
  live_ = {};
  cv::cvtColor(live.color, live_.grey, cv::COLOR_BGR2GRAY);
  if (network_ == nullptr) return;
  live_.features = network_->Find(live_.grey, options_.min_score);
}

std::vector<PointMotion> FrameMatcher::Match(int surface, const LiveView& live,
                                             const DenseFlow* flow) const {
  std::vector<PixelMatch> matches;
  if (before_.grey.empty()) return {};
  cv::Mat_<float> lost(surfaces_.size(), 0.f), asked(surfaces_.size(), 0.f);
  for (int v = 0; v < surfaces_.rows; v += options_.spacing) {
    for (int u = 0; u < surfaces_.cols; u += options_.spacing) {
      if (surfaces_(v, u) != surface) continue;
      const cv::Point pixel(u, v);
      const std::optional<cv::Point2f> place =
          flow == nullptr ? std::nullopt
                          : flow->Follow(pixel, options_.max_return);
      asked(pixel) = 1;
      if (place) {
        matches.push_back({pixel, *place});
      } else {
        lost(pixel) = 1;
      }
    }
  }
  if (options_.features) {
    const cv::Size window(2 * kWindowMargin + 1, 2 * kWindowMargin + 1);
    cv::boxFilter(lost, lost, CV_32F, window);
    cv::boxFilter(asked, asked, CV_32F, window);
    const cv::Mat_<std::uint8_t> often = lost > options_.lost_share * asked;
    const std::vector<PixelMatch> features =
        MatchFeatures(often & (surfaces_ == surface), live.labels == surface);
    matches = WithFeatures(matches, features);
  }
  return Lifted(matches, surface, live);
}

std::vector<PixelMatch> FrameMatcher::MatchFeatures(
    const cv::Mat_<std::uint8_t>& region,
    const cv::Mat_<std::uint8_t>& surface) const {
  const cv::Rect box = cv::boundingRect(region);
  if (box.empty()) return {};
  ImageFeatures before, now;
  Likeness likeness{options_.reach, options_.ratio, 0};
  if (network_ != nullptr) {
    before = FeaturesWithin(before_.features, region);
    now = FeaturesWithin(live_.features, surface);
    likeness = {options_.reach, 1, options_.min_cosine};
  } else {
    const int reach = static_cast<int>(options_.reach);
    before = SiftFeatures(before_.grey,
                          Around(box, kWindowMargin, region.size()), region);
    now = SiftFeatures(live_.grey, Around(box, reach, surface.size()), surface);
  }
  std::vector<PixelMatch> matches;
  for (const auto& [i, j] : AlikeFeatures(before, now, likeness)) {
    matches.push_back(
        {cv::Point2f(before.pixels[i]), cv::Point2f(now.pixels[j])});
  }
  return matches;
}

std::vector<PointMotion> FrameMatcher::Lifted(
    const std::vector<PixelMatch>& matches, int surface,
    const LiveView& live) const {
  std::vector<PointMotion> lifted;
  const PinholeCamera& camera = live.camera;
  for (const auto& [from, to] : matches) {
    const auto here = camera.PixelAt(Eigen::Vector2f(from.x, from.y));
    const auto there = camera.PixelAt(Eigen::Vector2f(to.x, to.y));
    if (!here || surfaces_(here->y(), here->x()) != surface || !there ||
        !IsCertain(live, surface, there->y(), there->x())) {
      continue;
    }
    lifted.push_back(
        {camera.BackProject(from.x, from.y, depth_(here->y(), here->x())),
         camera.BackProject(to.x, to.y, live.depth(there->y(), there->x()))});
  }
  return lifted;
}

void FrameMatcher::Keep(const LiveView& live) {
  before_ = std::move(live_);
  live_ = {};
  depth_ = live.depth.clone();
  surfaces_.create(live.labels.size());
  surfaces_.setTo(kNone);
  for (int v = 0; v < surfaces_.rows; ++v) {
    for (int u = 0; u < surfaces_.cols; ++u) {
      const int id = live.labels(v, u);
      if (IsCertain(live, id, v, u)) {
        surfaces_(v, u) = static_cast<std::uint16_t>(id);
      }
    }
  }
}

}  // namespace splitfusion
