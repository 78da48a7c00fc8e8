#include "splitfusion/lib/tracking/frame_matcher.h"

#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace splitfusion {
namespace {

constexpr std::uint16_t kNone = 0xffff;  // Layout.

/// About a feature, pixels: what it is described by.
constexpr int kWindowMargin = 24;
/// Flow that differs more from a feature within that is wrong, pixels.
constexpr double kAgreeing = 3;
/// Least contrast of a feature, of a grey range of 1.
constexpr double kContrast = 0.02;

cv::Rect Around(cv::Rect box, int margin, const cv::Size& size) {
  box -= cv::Point(margin, margin);
  box += cv::Size(2 * margin, 2 * margin);
  return box & cv::Rect({}, size);
}

/// Features of the points of a surface.
struct Features {
  std::vector<cv::Point2f> pixels;
  cv::Mat descriptors;  // Unit length, a row each.
};

Features FeaturesIn(const cv::Mat_<std::uint8_t>& grey, const cv::Rect& box,
                    const cv::Mat_<std::uint8_t>& mask) {
  Features found;
  std::vector<cv::KeyPoint> points;
  cv::SIFT::create(0, 3, kContrast)
      ->detectAndCompute(grey(box), mask(box), points, found.descriptors);
  for (const cv::KeyPoint& point : points) {
    found.pixels.push_back(point.pt + cv::Point2f(box.tl()));
  }
  for (int row = 0; row < found.descriptors.rows; ++row) {
    cv::Mat descriptor = found.descriptors.row(row);
    cv::sqrt(descriptor / std::max(1.0, cv::norm(descriptor, cv::NORM_L1)),
             descriptor);
  }
  return found;
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

/// For every row of `products`, cosines, the column that is best by far, see
/// MatchOptions::ratio; -1: none.
std::vector<int> BestColumns(const cv::Mat_<float>& products, double ratio) {
  std::vector<int> best(products.rows, -1);
  for (int row = 0; row < products.rows; ++row) {
    float first = -1, second = -1;
    for (int column = 0; column < products.cols; ++column) {
      const float product = products(row, column);
      if (product > first) {
        second = first, first = product, best[row] = column;
      } else if (product > second) {
        second = product;
      }
    }
    const float away = std::acos(std::min(1.0f, first));
    if (!(away <= ratio * std::acos(std::min(1.0f, second)))) {
      best[row] = -1;
    }
  }
  return best;
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
  list->Number("match_lost_share", &lost_share, Range::Share(), "",
               "That is where it lost a larger share of the points nearby.");
  list->Number("match_reach", &reach, Range::AtLeast(0), "pixels",
               "How far features are looked for.");
  list->Number("match_ratio", &ratio, Range::Share(), "",
               "A feature is matched if the angle to the most similar one is "
               "below this fraction of that to the second.");
}

std::vector<PointMotion> FrameMatcher::Match(int surface, const LiveView& live,
                                             const DenseFlow* flow) const {
  std::vector<PixelMatch> matches;
  if (grey_.empty()) return {};
  cv::Mat_<float> lost(grey_.size(), 0.f), asked(grey_.size(), 0.f);
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
    const std::vector<PixelMatch> features = MatchFeatures(
        live, cv::Mat_<std::uint8_t>(often & (surfaces_ == surface)), surface);
    matches = WithFeatures(matches, features);
  }
  return Lifted(matches, surface, live);
}

std::vector<PixelMatch> FrameMatcher::MatchFeatures(
    const LiveView& live, const cv::Mat_<std::uint8_t>& region,
    int surface) const {
  std::vector<PixelMatch> matches;
  const cv::Rect box = cv::boundingRect(region);
  if (box.empty()) return matches;
  const Features before =
      FeaturesIn(grey_, Around(box, kWindowMargin, grey_.size()), region);
  if (before.pixels.empty()) return matches;
  cv::Mat_<std::uint8_t> grey;
  cv::cvtColor(live.color, grey, cv::COLOR_BGR2GRAY);
  const Features now = FeaturesIn(
      grey, Around(box, static_cast<int>(options_.reach), grey.size()),
      live.labels == surface);
  if (now.pixels.empty()) return matches;
  cv::Mat_<float> products = before.descriptors * now.descriptors.t();
  for (int i = 0; i < products.rows; ++i) {
    for (int j = 0; j < products.cols; ++j) {
      if (cv::norm(before.pixels[i] - now.pixels[j]) > options_.reach) {
        products(i, j) = -1;
      }
    }
  }
  const std::vector<int> forth = BestColumns(products, options_.ratio);
  const std::vector<int> back = BestColumns(products.t(), options_.ratio);
  for (std::size_t i = 0; i < forth.size(); ++i) {
    if (forth[i] < 0 || back[forth[i]] != static_cast<int>(i)) continue;
    matches.push_back({before.pixels[i], now.pixels[forth[i]]});
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
  cv::cvtColor(live.color, grey_, cv::COLOR_BGR2GRAY);
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
