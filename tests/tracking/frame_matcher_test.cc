#include "splitfusion/lib/tracking/frame_matcher.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <sstream>

#include "splitfusion/lib/base/archive.h"

namespace splitfusion {
namespace {

const PinholeCamera kMatchedCamera{320, 240, 260, 260, 160, 120};
constexpr float kDepth = 1.3f;
const cv::Rect kCard(60, 80, 80, 80);

cv::Mat RandomColor(int seed, const cv::Size& size) {
  cv::Mat color(size, CV_8UC3);
  cv::RNG random(seed);
  random.fill(color, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(color, color, cv::Size(), 1.5);
  cv::normalize(color, color, 0, 255, cv::NORM_MINMAX);
  return color;
}

/// Surface 1, a plate, before which a card, also of it, has moved by `way`.
LiveView ViewOfCard(const cv::Point& way) {
  cv::Mat color = RandomColor(1, {320, 240});
  RandomColor(2, kCard.size()).copyTo(color(kCard + way));
  LiveView live =
      MakeLiveView(kMatchedCamera, cv::Mat_<float>(240, 320, kDepth), color);
  live.labels.setTo(1);
  return live;
}

/// Takes a view for the frame before.
void Keep(FrameMatcher* matcher, const LiveView& live) {
  matcher->Begin(live);
  matcher->Keep(live);
}

/// Matches that begin within the card, and how many of them have the way.
struct CardMatches {
  int all = 0;
  int right = 0;
};

CardMatches Matched(FrameMatcher* matcher, const LiveView& live,
                    const cv::Point& way) {
  matcher->Begin(live);
  const Eigen::Vector3f step(way.x * kDepth / 260, way.y * kDepth / 260, 0);
  CardMatches card;
  for (const PointMotion& motion : matcher->Match(1, live, nullptr)) {
    const auto pixel = kMatchedCamera.PixelOf(motion.from);
    if (!kCard.contains({pixel->x(), pixel->y()})) continue;
    ++card.all;
    card.right += (motion.to - motion.from - step).norm() < 0.008f;
  }
  return card;
}

TEST(FrameMatcher, FindsWhatJumpedFartherThanFlowFollows) {
  FrameMatcher matcher{MatchOptions()};
  EXPECT_EQ(Matched(&matcher, ViewOfCard({0, 0}), {0, 0}).all, 0);
  Keep(&matcher, ViewOfCard({0, 0}));
  const cv::Point way(60, -20);
  const CardMatches card = Matched(&matcher, ViewOfCard(way), way);
  EXPECT_GT(card.right, 40);
  EXPECT_GT(card.right, 0.8 * card.all);
}

TEST(FrameMatcher, FollowsFlowWhereThatComesBack) {
  const LiveView before = ViewOfCard({0, 0}), live = ViewOfCard({3, 2});
  FrameMatcher matcher{MatchOptions()};
  Keep(&matcher, before);
  matcher.Begin(live);
  cv::Mat_<std::uint8_t> from, to;
  cv::cvtColor(before.color, from, cv::COLOR_BGR2GRAY);
  cv::cvtColor(live.color, to, cv::COLOR_BGR2GRAY);
  const DenseFlow flow(from, to, cv::Rect({}, from.size()),
                       cv::Mat_<cv::Vec2f>(from.size(), cv::Vec2f(0, 0)));
  const std::vector<PointMotion> matches = matcher.Match(1, live, &flow);
  EXPECT_GT(matches.size(), 3000u);
  int right = 0, all = 0;
  const Eigen::Vector3f step(3 * kDepth / 260, 2 * kDepth / 260, 0);
  for (const PointMotion& motion : matches) {
    const auto pixel = kMatchedCamera.PixelOf(motion.from);
    if (!(kCard - cv::Size(16, 16) + cv::Point(8, 8))
             .contains({pixel->x(), pixel->y()})) {
      continue;
    }
    ++all;
    right += (motion.to - motion.from - step).norm() < 0.004f;
  }
  EXPECT_GT(right, 0.9 * all);
}

TEST(FrameMatcher, MatchesWithinTheSurfaceOnly) {
  FrameMatcher matcher{MatchOptions()};
  Keep(&matcher, ViewOfCard({0, 0}));
  const cv::Point way(60, -20);
  LiveView live = ViewOfCard(way);
  live.labels(kCard + way).setTo(2);
  EXPECT_EQ(Matched(&matcher, live, way).right, 0);
  EXPECT_TRUE(matcher.Match(3, live, nullptr).empty());
}

TEST(FrameMatcher, GoesOnAfterItWasRestored) {
  FrameMatcher matcher{MatchOptions()};
  Keep(&matcher, ViewOfCard({0, 0}));
  FrameMatcher restored{MatchOptions()};
  std::ostringstream out;
  ArchiveWriter writer(&out);
  writer(matcher);
  writer.Flush();
  std::istringstream in(out.str());
  ArchiveReader reader(&in, out.str().size(), "matcher.bin");
  reader(restored);
  const LiveView live = ViewOfCard({30, 10});
  matcher.Begin(live);
  restored.Begin(live);
  const auto matches = matcher.Match(1, live, nullptr);
  const auto again = restored.Match(1, live, nullptr);
  ASSERT_EQ(matches.size(), again.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    EXPECT_EQ(matches[i].from, again[i].from);
    EXPECT_EQ(matches[i].to, again[i].to);
  }
}

}  // namespace
}  // namespace splitfusion
