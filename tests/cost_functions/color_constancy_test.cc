#include "splitfusion/cost_functions/color_constancy.h"

#include <gtest/gtest.h>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/term_registry.h"
#include "splitfusion/lib/energy/warp_functor.h"
#include "support/gradient_check.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"
#include "support/term_energy.h"

namespace splitfusion {
namespace {

constexpr double kUnit = 0.05;  // Metres a grey value of 1 counts for.

ColorConstancy Sample() {
  ColorConstancy color{};
  color.focal = {130, 131};
  color.offset = {80 - 100, 60 - 40};
  color.gradient = {0.02, -0.01};
  color.difference = 0.1;
  color.sqrt_confidence = 0.5;
  color.metres = kUnit;
  return color;
}

double Value(const ColorConstancy& color, const Eigen::Vector3d& x) {
  double residual = 0;
  color(x.data(), &residual);
  return residual;
}

/// Point at z-depth `z` that is seen at a pixel.
Eigen::Vector3d PointAt(double u, double v, double z) {
  return {(u - 80) / 130 * z, (v - 60) / 131 * z, z};
}

TEST(ColorConstancy, ValueByHand) {
  EXPECT_NEAR(Value(Sample(), PointAt(100, 40, 1.3)), kUnit * 0.5 * 0.1, 1e-12);
  // Three pixels to the right, two down: 0.1 + 0.06 - 0.02.
  EXPECT_NEAR(Value(Sample(), PointAt(103, 42, 1.3)), kUnit * 0.5 * 0.14,
              1e-12);
}

TEST(ColorConstancy, DoesNotChangeAlongTheViewRay) {
  const double value = Value(Sample(), PointAt(103, 42, 1));
  for (const double z : {0.5, 2.0, 10.0}) {
    EXPECT_NEAR(Value(Sample(), PointAt(103, 42, z)), value, 1e-12);
  }
}

TEST(ColorConstancy, IsZeroWhereTheBrightnessAgrees) {
  ColorConstancy color = Sample();
  color.difference = -0.02;
  EXPECT_NEAR(Value(color, PointAt(101, 40, 1.7)), 0, 1e-12);
}

TEST(ColorConstancy, GradientsMatchNumeric) {
  DeformationGraph graph = CoverWithNodes(PlateMesh(0.2, 0.2, 0.01, 1), 0.04);
  Shake(0.05, /*seed=*/1, &graph);
  const Eigen::Vector3f point(0.11f, -0.07f, 1);
  const Skinning skinning = SkinningIndex(graph, 6).Skin(point);
  const auto cost = AutoDiffOverTwists(
      WarpFunctor<ColorConstancy>(graph, skinning, point, Sample()),
      skinning.count, 1);
  for (const double size : {0.0, 0.01, 0.3}) {
    EXPECT_GRADIENTS_MATCH(*cost,
                           RandomTwists(skinning.count, size, /*seed=*/2));
  }
}

TEST(ColorConstancyTerm, TakesTheCorrespondencesAndTheCamera) {
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  const PinholeCamera camera = SmallCamera();
  Correspondence c;
  c.model.point = camera.BackProject<float>(90, 50, 1.5f);
  c.model.normal = c.warped_normal = c.target_normal = {0, 0, -1};
  c.target = c.model.point;
  c.model.skinning.count = 1;
  c.model.skinning.weights[0] = 1;
  c.pixel = {90, 50};
  c.intensity_difference = 0.2f;
  c.intensity_gradient = {0.1f, 0};
  c.weight = 0.75f;
  Correspondence far = c;
  far.intensity_difference = 0;
  far.weight = 0.25f;
  const TermOptions options{"color", 1, LossKind::kTrivial, 0.01};
  const AddedResiduals added =
      ResidualsOf(ColorConstancyTerm(), {graph, {c, far}, camera}, options);
  EXPECT_EQ(added.residual_vectors, 2);
  // 0.2 in grey value count like 1 cm; a mean weighted by the confidence.
  EXPECT_NEAR(EnergyOf(graph, added.residuals), 0.75, 1e-5);
}

TEST(ExposedColorConstancy, ValueByHand) {
  const ExposedColorConstancy exposed{Sample(), /*model_intensity=*/0.4};
  const Eigen::Vector3d x = PointAt(103, 42, 1.3);
  const auto value = [&](double gain, double offset) {
    const double unknowns[2] = {gain, offset};
    double residual = 0;
    exposed(x.data(), unknowns, &residual);
    return residual;
  };
  EXPECT_EQ(value(1, 0), Value(Sample(), x));
  // I = 0.54: 0.54 - 1.2 * 0.4 - 0.05.
  EXPECT_NEAR(value(1.2, 0.05), kUnit * 0.5 * 0.01, 1e-12);
}

TEST(ExposurePrior, IsZeroWhereTheImageIsAsTheModel) {
  const ExposurePrior prior{kUnit};
  double residual[2];
  const double same[2] = {1, 0}, other[2] = {1.5, -0.1};
  prior(same, residual);
  EXPECT_EQ(residual[0], 0);
  EXPECT_EQ(residual[1], 0);
  prior(other, residual);
  EXPECT_NEAR(residual[0], 0.5 * kUnit, 1e-12);
  EXPECT_NEAR(residual[1], -0.1 * kUnit, 1e-12);
}

TEST(ColorConstancyTerm, DeclaresGainAndOffsetOnlyIfAskedFor) {
  const auto unknowns = [](const std::string& text) {
    return ParseEnergy(text, BuiltinTerms()).front().term->Unknowns();
  };
  EXPECT_TRUE(unknowns("color").empty());
  EXPECT_TRUE(unknowns("color(exposure=false)").empty());
  const std::vector<Unknown> both = unknowns("color(exposure=true)");
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].name, "gain");
  EXPECT_EQ(both[0].initial, 1);
  EXPECT_EQ(both[1].name, "offset");
  EXPECT_EQ(both[1].initial, 0);
}

TEST(ColorConstancyTerm, CountsGreyValuesAsAskedFor) {
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  Correspondence c{};
  c.model.point = {0, 0, 1.5f};
  c.model.normal = c.warped_normal = c.target_normal = {0, 0, -1};
  c.target = c.model.point;
  c.model.skinning.count = 1;
  c.model.skinning.weights[0] = 1;
  c.intensity_difference = 0.2f;
  const auto energy = [&](const std::string& text) {
    const WeightedTerm term = ParseEnergy(text, BuiltinTerms()).front();
    return EnergyOf(graph, ResidualsOf(*term.term, {graph, {c}, SmallCamera()},
                                       term.options)
                               .residuals);
  };
  EXPECT_NEAR(energy("color(metres=0.1)"), 4 * energy("color"), 1e-6);
}

}  // namespace
}  // namespace splitfusion
