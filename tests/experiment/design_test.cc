#include "splitfusion/lib/experiment/design.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

const std::vector<Axis> kAxes = {{"weight", {"log:1..100"}},
                                 {"voxel", {"0.004..0.006"}},
                                 {"nodes", {"10..12"}},
                                 {"solver", {"gn_pcg", "ceres"}}};

double Value(const Settings& point, const char* key) {
  return std::atof(point.Find(key)->c_str());
}

TEST(Design, AGridHasEveryCombination) {
  const auto points = ExpandGrid({{"a", {"1", "2"}}, {"b", {"x", "y", "z"}}});
  ASSERT_EQ(points.size(), 6u);
  EXPECT_EQ(SettingsText(points[0]), "a=1; b=x");
  EXPECT_EQ(SettingsText(points[5]), "a=2; b=z");
  EXPECT_EQ(ExpandGrid({}).size(), 1u);
  ExpectInputError([] { ExpandGrid(kAxes); }, "--random");
}

TEST(Design, RandomPointsLieInTheirRanges) {
  std::set<std::string> nodes, solvers;
  int small = 0;
  for (const Settings& point : DrawDesign(kAxes, 200, 1)) {
    EXPECT_GE(Value(point, "weight"), 1);
    EXPECT_LE(Value(point, "weight"), 100);
    EXPECT_GE(Value(point, "voxel"), 0.004);
    EXPECT_LE(Value(point, "voxel"), 0.006);
    nodes.insert(*point.Find("nodes"));
    solvers.insert(*point.Find("solver"));
    small += Value(point, "weight") < 10 ? 1 : 0;
  }
  EXPECT_EQ(nodes, (std::set<std::string>{"10", "11", "12"}));
  EXPECT_EQ(solvers.size(), 2u);
  EXPECT_GT(small, 70);  // Half of them, by the logarithm.
  EXPECT_LT(small, 130);
}

TEST(Design, TheSeedDecidesItAndMorePointsOnlyAddSome) {
  const auto points = DrawDesign(kAxes, 5, 7), more = DrawDesign(kAxes, 9, 7);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].entries(), more[i].entries());
  }
  EXPECT_NE(points[0].entries(), DrawDesign(kAxes, 1, 8)[0].entries());
  // On every machine the same.
  EXPECT_EQ(StableHash("repeat 1"), StableHash(std::string("repeat 1")));
  EXPECT_EQ(SettingsText(points[0]), SettingsText(DrawDesign(kAxes, 1, 7)[0]));
}

TEST(Design, RefusesWhatIsNoRange) {
  ExpectInputError([] { DrawDesign({}, 3, 1); }, "--grid");
  ExpectInputError([] { DrawDesign({{"a", {"2..1"}}}, 3, 1); }, "lo < hi");
  ExpectInputError([] { DrawDesign({{"a", {"log:0..1"}}}, 3, 1); }, "log");
}

}  // namespace
}  // namespace splitfusion
