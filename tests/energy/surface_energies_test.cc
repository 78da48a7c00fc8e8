#include "splitfusion/lib/energy/surface_energies.h"

#include <gtest/gtest.h>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

SurfaceEnergies Parse(const std::string& text) {
  return SurfaceEnergies::Parse(text, BuiltinTerms());
}

const WeightedTerm& TermOf(const SurfaceEnergies& energies,
                           const std::string& class_name, std::size_t i) {
  return energies.Of(class_name).at(i);
}

TEST(SurfaceEnergies, AClassChangesWhatItSpellsOut) {
  const SurfaceEnergies energies = Parse(
      "color(weight=2,metres=0.1) person.arap(weight=4) arap(weight=8,"
      "loss=huber) person.color(metres=0.2)");
  EXPECT_EQ(TermOf(energies, "background", 0).options.weight, 2);
  EXPECT_EQ(TermOf(energies, "background", 1).options.weight, 8);
  EXPECT_EQ(TermOf(energies, "person", 1).options.weight, 4);
  EXPECT_EQ(TermOf(energies, "person", 1).options.loss, LossKind::kHuber);
  // Terms are not shared: the key of one is none of the other's.
  EXPECT_EQ(TermOptionValues(energies.all()).at("color.metres"), "0.1");
  EXPECT_EQ(TermOptionValues(energies.Of("person")).at("color.metres"), "0.2");
  EXPECT_EQ(&energies.Of("dog"), &energies.all());
  EXPECT_EQ(energies.classes(), std::vector<std::string>{"person"});
}

TEST(SurfaceEnergies, ATermMayBeOfOneClassOnly) {
  const SurfaceEnergies energies = Parse("arap teddy_bear.velocity(weight=3)");
  EXPECT_EQ(energies.all().size(), 1u);
  ASSERT_EQ(energies.Of("teddy bear").size(), 2u);
  EXPECT_EQ(TermOf(energies, "teddy bear", 1).options.name, "velocity");
  EXPECT_EQ(TermOf(energies, "teddy bear", 1).options.weight, 3);
}

TEST(SurfaceEnergies, AreSetOneByOne) {
  SurfaceEnergies energies = Parse("arap(weight=8)");
  energies.Set("person.terms.arap.weight", "4.0", BuiltinTerms());
  energies.Set("terms.arap.weight", "6", BuiltinTerms());
  energies.Set("terms.arap.scale", "0.5", BuiltinTerms());
  EXPECT_EQ(energies.all()[0].options.weight, 6);
  EXPECT_EQ(TermOf(energies, "person", 0).options.weight, 4);
  EXPECT_EQ(TermOf(energies, "person", 0).options.scale, 0.5) << "that of all";
  const auto values = energies.OptionValues();
  EXPECT_EQ(values.at("terms.arap.weight"), "6");
  EXPECT_EQ(values.at("person.terms.arap.weight"), "4");
  EXPECT_EQ(values.count("person.terms.arap.scale"), 0u);
}

TEST(SurfaceEnergies, TheirTextReadsBack) {
  const std::string text =
      "arap(weight=8,loss=trivial,scale=0.01) background.color(metres=0.1) "
      "person.arap(loss=huber,weight=4) person.color(weight=2)";
  EXPECT_EQ(Parse(text).Text(), text);
  EXPECT_EQ(Parse(Parse(text).Text()).OptionValues(),
            Parse(text).OptionValues());
  const std::string plain = "arap(weight=8,loss=trivial,scale=0.01)";
  EXPECT_EQ(Parse(plain).Text(), plain);
}

TEST(SurfaceEnergies, KeysAreOfTheEnergyWithAndWithoutAClass) {
  EXPECT_TRUE(IsTermKey("terms.arap.weight"));
  EXPECT_TRUE(IsTermKey("person.terms.arap.weight"));
  EXPECT_FALSE(IsTermKey("terms"));
  EXPECT_FALSE(IsTermKey("terms_library"));
  EXPECT_FALSE(IsTermKey("object_voxel"));
  EXPECT_EQ(ClassKey("dining table"), "dining_table");
}

TEST(SurfaceEnergies, WhatIsWrongIsNamed) {
  const auto refused = [](const std::string& text, const std::string& message) {
    SCOPED_TRACE(text);
    ExpectInputError([&] { Parse(text).Check(); }, message);
  };
  refused("arap person.arapp(weight=1)", "term = arapp: expected point_to");
  refused("arap person.arap(wieght=1)",
          "--terms: key 'wieght' of term 'arap': expected weight, loss");
  refused("arap person.arap(weight=-1)", "arap.weight = -1: expected >= 0");
  refused("arap person.arap",
          "--terms: 'person.arap': expected CLASS.NAME(KEY=VALUE,...)");
  refused("arap person.", "--terms: 'person.': expected CLASS.NAME(KEY=");
  refused("arap .arap(weight=1)", "term = ''");
  refused("person.arap(weight=1)", "--terms is empty");
  refused("arap person.arap(weight=0)",
          "of class person: --terms: all weights are 0");
  SurfaceEnergies energies = Parse("arap");
  for (const std::string key : {"person.arap.weight", ".terms.arap.weight"}) {
    ExpectInputError([&] { energies.Set(key, "1", BuiltinTerms()); },
                     key + ": expected terms.NAME.KEY or CLASS.terms.NAME.KEY");
  }
  ExpectInputError(
      [&] { ParseEnergy("arap person.arap(weight=1)", BuiltinTerms()); },
      "--terms: 'person.arap': expected a term of all surfaces");
}

}  // namespace
}  // namespace splitfusion
