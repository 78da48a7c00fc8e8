#include "splitfusion/lib/geometry/nearest_point.h"

#include <gtest/gtest.h>

#include <random>

namespace splitfusion {
namespace {

std::vector<Eigen::Vector3f> RandomPoints(int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1, 1);
  std::vector<Eigen::Vector3f> points(count);
  for (Eigen::Vector3f& p : points) {
    // Flat, like a surface.
    p = {place(random), place(random), 0.1f * place(random)};
  }
  return points;
}

float Squared(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const Eigen::Vector3f d = a - b;
  return d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
}

int NearestByHand(const std::vector<Eigen::Vector3f>& points,
                  const Eigen::Vector3f& query) {
  int best = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (Squared(points[i], query) < Squared(points[best], query)) {
      best = static_cast<int>(i);
    }
  }
  return best;
}

TEST(NearestPoint, IsTheNearestOfAll) {
  for (const int count : {1, 2, 7, 8, 9, 100, 1777}) {
    const auto points = RandomPoints(count, 1);
    const NearestPoint nearest(points);
    for (const Eigen::Vector3f& query : RandomPoints(300, 2)) {
      float distance = 0;
      const int found = nearest.Find(query, -1, &distance);
      EXPECT_EQ(found, NearestByHand(points, query)) << count << " points";
      EXPECT_EQ(distance, std::sqrt(Squared(points[found], query)));
    }
  }
}

TEST(NearestPoint, AHintDoesNotChangeTheAnswer) {
  const auto points = RandomPoints(500, 3);
  const NearestPoint nearest(points);
  for (const Eigen::Vector3f& query : RandomPoints(100, 4)) {
    const int found = nearest.Find(query, -1, nullptr);
    for (const int hint : {0, 250, 499, found}) {
      EXPECT_EQ(nearest.Find(query, hint, nullptr), found);
    }
  }
}

TEST(NearestPoint, TheFirstOfEqualsIsTaken) {
  // Points of a lattice, each twice, asked from the middles between them.
  std::vector<Eigen::Vector3f> points;
  for (int copy = 0; copy < 2; ++copy) {
    for (int i = 0; i < 125; ++i) {
      points.emplace_back(i % 5, i / 5 % 5, i / 25);
    }
  }
  const NearestPoint nearest(points);
  for (int i = 0; i < 64; ++i) {
    const Eigen::Vector3f query(0.5f + i % 4, 0.5f + i / 4 % 4, i / 16);
    EXPECT_EQ(nearest.Find(query, -1, nullptr), NearestByHand(points, query));
    EXPECT_EQ(nearest.Find(query, 249, nullptr), NearestByHand(points, query));
  }
}

}  // namespace
}  // namespace splitfusion
