#include "splitfusion/lib/energy/term_registry.h"

#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/energy/energy_term.h"
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

/// A term with parameters of its own.
class StretchTerm : public EnergyTerm {
 public:
  void List(OptionList* list) override {
    list->Number("length", &length, Range::Above(0), "metres", "At rest.");
    list->Number("rings", &rings, {1, 5}, "", "Neighbours of neighbours.");
    list->Choice("norm", &norm, {"l1", "l2"}, "Of what.");
    list->Switch("signed", &is_signed, "Shrinking counts, too.");
  }
  void AddResiduals(const EnergyInput&, ResidualSink*) const override {}

  double length = 0.5;
  int rings = 1;
  std::string norm = "l2";
  bool is_signed = true;
};

TermRegistry WithStretch() {
  TermRegistry terms = BuiltinTerms();
  terms.Register("stretch", [] { return std::make_unique<StretchTerm>(); });
  return terms;
}

const StretchTerm& Stretch(const Energy& energy) {
  return dynamic_cast<const StretchTerm&>(*energy.front().term);
}

TEST(TermParameters, AreKeysBesideWeightLossAndScale) {
  const Energy energy = ParseEnergy(
      "stretch(length=0.25, weight=3, rings=2, norm=l1, signed=false) "
      "stretch",
      WithStretch());
  EXPECT_EQ(energy[0].options.weight, 3);
  EXPECT_EQ(Stretch(energy).length, 0.25);
  EXPECT_EQ(Stretch(energy).rings, 2);
  EXPECT_EQ(Stretch(energy).norm, "l1");
  EXPECT_FALSE(Stretch(energy).is_signed);
  EXPECT_EQ(Stretch({energy[1]}).length, 0.5) << "a term of its own";
  EXPECT_EQ(EnergyText(energy),
            "stretch(weight=3,loss=trivial,scale=0.01,length=0.25,rings=2,"
            "norm=l1,signed=false) stretch(weight=1,loss=trivial,scale=0.01,"
            "length=0.5,rings=1,norm=l2,signed=true)");
  EXPECT_EQ(EnergyText(ParseEnergy(EnergyText(energy), WithStretch())),
            EnergyText(energy));
  const auto values = TermOptionValues(energy);
  EXPECT_EQ(values.at("stretch.length"), "0.25");
  EXPECT_EQ(values.at("stretch.2.rings"), "1");
}

TEST(TermParameters, AreSetOneByOne) {
  Energy energy = ParseEnergy("arap", WithStretch());
  SetTermOption("stretch.length", "2", WithStretch(), &energy);
  SetTermOption("stretch.loss", "huber", WithStretch(), &energy);
  ASSERT_EQ(energy.size(), 2u);
  EXPECT_EQ(Stretch({energy[1]}).length, 2);
  EXPECT_EQ(energy[1].options.loss, LossKind::kHuber);
  ExpectInputError(
      [&] { SetTermOption("stretch", "2", WithStretch(), &energy); },
      "terms.stretch: expected terms.NAME.KEY, as in terms.arap.weight");
}

TEST(TermParameters, AreCheckedAndListedByMessages) {
  const auto refused = [](const std::string& text, const std::string& message) {
    ExpectInputError([&] { ParseEnergy(text, WithStretch()); }, message);
  };
  refused("stretch(length=0)", "stretch.length = 0: expected metres > 0");
  refused("stretch(rings=1.5)", "stretch.rings = 1.5: expected 1..5");
  refused("stretch(norm=l3)", "stretch.norm = l3: expected l1 or l2");
  refused("stretch(lenght=1)",
          "--terms: key 'lenght' of term 'stretch': expected weight, loss, "
          "scale, length, rings, norm or signed");
}

TEST(TermParameters, MustNotShareANameWithAnother) {
  class TwoWeights : public StretchTerm {
    void List(OptionList* list) override {
      list->Number("weight", &length, Range::Above(0), "", "Of its own.");
    }
  };
  TermRegistry terms("term");
  terms.Register("two", [] { return std::make_unique<TwoWeights>(); });
  ExpectInputError([&] { ParseEnergy("two(weight=1)", terms); },
                   "term 'two' has the key 'weight' twice");
}

TEST(TermParameters, AreCheckedTogetherAndWithTheirDefaults) {
  class BadDefault : public StretchTerm {
    void List(OptionList* list) override {
      list->Number("length", &length, Range::Above(1), "metres", "At rest.");
    }
  };
  class Ordered : public StretchTerm {
    void List(OptionList* list) override {
      list->Number("rings", &rings, {1, 5}, "", "");
      list->Number("length", &length, Range::Above(0), "", "");
      list->Demand(length < rings, "length", "less than rings");
    }
  };
  TermRegistry terms("term");
  terms.Register("bad", [] { return std::make_unique<BadDefault>(); });
  terms.Register("ordered", [] { return std::make_unique<Ordered>(); });
  terms.Register("none", [] { return std::unique_ptr<EnergyTerm>(); });
  terms.Register("my-term", [] { return std::make_unique<StretchTerm>(); });
  ExpectInputError([&] { ParseEnergy("bad", terms); },
                   "bad.length = 0.5: expected metres > 1");
  ExpectInputError(
      [&] { CheckEnergy(ParseEnergy("ordered(length=3)", terms)); },
      "ordered.length = 3: expected less than rings");
  ExpectInputError([&] { ParseEnergy("none", terms); },
                   "term 'none': its factory made nothing");
  Energy energy = ParseEnergy("ordered", terms);
  ExpectInputError(
      [&] { SetTermOption("my-term.weight", "1", terms, &energy); },
      "name of a term = my-term: expected letters, digits and _");
}

TEST(TermParameters, ReadBackWhateverTheyAre) {
  class WithText : public StretchTerm {
    void List(OptionList* list) override {
      list->Text("file", &norm, "Of matches.");
    }
  };
  TermRegistry terms("term");
  terms.Register("text", [] { return std::make_unique<WithText>(); });
  Energy energy = ParseEnergy("text(file=a/b.csv)", terms);
  EXPECT_EQ(EnergyText(ParseEnergy(EnergyText(energy), terms)),
            EnergyText(energy));
  ExpectInputError(
      [&] { SetTermOption("text.file", "a,b", terms, &energy); },
      "text.file = a,b: expected a value without brackets and commas");
}

TEST(TermsHelp, HasANameALineAndAllElseIndented) {
  std::istringstream help(TermsHelp(WithStretch()));
  std::vector<std::string> names;
  std::string text;
  for (std::string line; std::getline(help, line); text += line + "\n") {
    ASSERT_FALSE(line.empty());
    if (line.front() != ' ') names.push_back(line);
  }
  EXPECT_EQ(names, WithStretch().names());
  EXPECT_NE(text.find("stretch\n  length = 0.5 (metres > 0)\n      At rest.\n"),
            std::string::npos)
      << text;
}

TEST(ParseEnergy, ValuesMustBeNumbersInRange) {
  ExpectRefused("arap(weight=five)", "arap.weight = five: expected >= 0");
  ExpectRefused("arap(weight=5x)", "arap.weight = 5x: expected >= 0");
  ExpectRefused("arap(weight=)", "arap.weight = : expected >= 0");
  ExpectRefused("arap(weight=nan)", "arap.weight = nan: expected >= 0");
  ExpectRefused("arap(weight=1e999)", "arap.weight = 1e999: expected >= 0");
  ExpectRefused("arap(weight=-1)", "arap.weight = -1: expected >= 0");
  ExpectRefused("arap(scale=0)", "arap.scale = 0: expected metres > 0");
  ExpectRefused(
      "point_to_plane(loss=l2)",
      "point_to_plane.loss = l2: expected trivial, huber, tukey or cauchy");
}

}  // namespace
}  // namespace splitfusion
