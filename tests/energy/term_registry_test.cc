#include "splitfusion/lib/energy/term_registry.h"

#include <gtest/gtest.h>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

void ExpectRefused(const std::string& text, const std::string& message) {
  SCOPED_TRACE("--terms=" + text);
  ExpectInputError([&] { ParseEnergy(text, BuiltinTerms()); }, message);
}

TEST(ParseEnergy, ReadsTermsWithTheirOptions) {
  const Energy energy = ParseEnergy(
      "point_to_plane(weight=1.5, loss=tukey ,scale=2e-2)\n  arap( weight = 5 "
      ")",
      BuiltinTerms());
  ASSERT_EQ(energy.size(), 2u);
  EXPECT_EQ(energy[0].options.name, "point_to_plane");
  EXPECT_EQ(energy[0].options.weight, 1.5);
  EXPECT_EQ(energy[0].options.loss, LossKind::kTukey);
  EXPECT_EQ(energy[0].options.scale, 0.02);
  EXPECT_EQ(energy[1].options.name, "arap");
  EXPECT_EQ(energy[1].options.weight, 5);
}

TEST(ParseEnergy, LeavesOutWhatHasADefault) {
  const TermOptions defaults;
  for (const char* text : {"arap", "arap()", " arap "}) {
    const Energy energy = ParseEnergy(text, BuiltinTerms());
    ASSERT_EQ(energy.size(), 1u) << text;
    EXPECT_EQ(energy[0].options.weight, defaults.weight);
    EXPECT_EQ(energy[0].options.loss, defaults.loss);
    EXPECT_EQ(energy[0].options.scale, defaults.scale);
  }
  EXPECT_EQ(ParseEnergy("arap(weight=0)", BuiltinTerms())[0].options.weight, 0);
}

TEST(CheckEnergy, AsksForOneWeight) {
  CheckEnergy(ParseEnergy("arap(weight=0) color", BuiltinTerms()));
  ExpectInputError(
      [] { CheckEnergy(ParseEnergy("arap(weight=0)", BuiltinTerms())); },
      "--terms: all weights are 0: expected one above 0");
}

TEST(ParseEnergy, UnknownTermsListTheKnownOnes) {
  const std::string known = ": expected point_to_plane, color,";
  ExpectRefused("arapp(weight=1)", "term = arapp" + known);
  ExpectRefused("arap, point_to_plane", "term = ''" + known);
  ExpectRefused("arap)", "term = ''" + known);
  ExpectRefused("Arap", "term = Arap" + known);
}

TEST(ParseEnergy, NothingIsNoEnergy) {
  const std::string message =
      "--terms is empty: expected one or more of point_to_plane, color,";
  ExpectRefused("", message);
  ExpectRefused(" \t\n", message);
}

TEST(ParseEnergy, SyntaxErrorsNameTheTerm) {
  ExpectRefused("arap(weight=5",
                "--terms: '(' of term 'arap' is not closed: expected ')'");
  ExpectRefused("arap(weight)",
                "--terms: 'weight' in term 'arap': expected key=value");
  ExpectRefused("arap(weight=1,,scale=1)",
                "--terms: '' in term 'arap': expected key=value");
}

TEST(ParseEnergy, UnknownKeysListTheKnownOnes) {
  ExpectRefused("arap(wieght=5)",
                "--terms: key 'wieght' of term 'arap': expected weight, loss "
                "or scale");
}

TEST(ParseEnergy, ValuesMustBeNumbersInRange) {
  ExpectRefused("arap(weight=five)", "arap.weight = five: expected a number");
  ExpectRefused("arap(weight=5x)", "arap.weight = 5x: expected a number");
  ExpectRefused("arap(weight=)", "arap.weight = : expected a number");
  ExpectRefused("arap(weight=nan)", "arap.weight = nan: expected a number");
  ExpectRefused("arap(weight=1e999)", "arap.weight = 1e999: expected a number");
  ExpectRefused("arap(weight=-1)", "arap.weight = -1: expected a number >= 0");
  ExpectRefused("arap(scale=0)", "arap.scale = 0: expected metres > 0");
  ExpectRefused("point_to_plane(loss=l2)",
                "loss = l2: expected trivial, huber, tukey or cauchy");
}

}  // namespace
}  // namespace splitfusion
