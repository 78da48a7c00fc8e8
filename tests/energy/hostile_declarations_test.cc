// Terms that declare what they must not, texts of energies that are none, and
// terms whose states are wrong: what is refused says whose it is.

#include <gtest/gtest.h>

#include <new>
#include <sstream>
#include <utility>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/energy/gradient_check.h"
#include "splitfusion/lib/energy/surface_energies.h"
#include "splitfusion/lib/energy/term_residuals.h"
#include "support/expect_input_error.h"
#include "support/hostile_solve.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// A text of --terms and what its refusal says.
struct RefusedText {
  std::string name, text, message;
};

void PrintTo(const RefusedText& text, std::ostream* out) { *out << text.name; }

/// Terms with one whose keys are of all kinds.
TermRegistry WithKeys() {
  struct Fields {
    double reach = 1;
    int rings = 1;
    bool robust = false;
    std::string norm = "l2", file;
  };
  TermRegistry terms = BuiltinTerms();
  terms.Register("keyed", [] {
    auto term = std::make_unique<HostileTerm>();
    term->list = [fields = std::make_shared<Fields>()](OptionList* list) {
      list->Number("reach", &fields->reach, {0, 2}, "metres", "");
      list->Number("rings", &fields->rings, {1, 5}, "", "");
      list->Switch("robust", &fields->robust, "");
      list->Choice("norm", &fields->norm, {"l1", "l2"}, "");
      list->Text("file", &fields->file, "");
    };
    return term;
  });
  return terms;
}

class HostileTexts : public ::testing::TestWithParam<RefusedText> {};

TEST_P(HostileTexts, AreRefused) {
  ExpectInputError(
      [] { SurfaceEnergies::Parse(GetParam().text, WithKeys()).Check(); },
      GetParam().message);
}

std::vector<RefusedText> Texts() {
  const std::string keyed = "keyed.", key = "--terms: key '";
  return {
      {"no_number", "keyed(reach=far)", keyed + "reach = far: expected 0..2"},
      {"number_nan", "keyed(reach=nan)", keyed + "reach = nan: expected 0..2"},
      {"number_infinite", "keyed(reach=inf)", keyed + "reach = inf: expected"},
      {"number_too_large", "keyed(reach=1e999)", keyed + "reach = 1e999: "},
      {"number_out_of_range", "keyed(reach=2.1)", keyed + "reach = 2.1: "},
      {"number_in_hexadecimal", "keyed(reach=0x1)", keyed + "reach = 0x1: "},
      {"number_with_a_tail", "keyed(reach=1m)", keyed + "reach = 1m: "},
      {"number_with_a_sign", "keyed(reach=+1)", keyed + "reach = +1: "},
      {"integer_with_a_point", "keyed(rings=1.0)", keyed + "rings = 1.0: "},
      {"integer_too_large", "keyed(rings=99999999999999999999)",
       keyed + "rings = 99999999999999999999: expected 1..5"},
      {"switch_of_1", "keyed(robust=1)", keyed + "robust = 1: expected true"},
      {"choice_of_nothing", "keyed(norm=)", keyed + "norm = : expected l1 or"},
      {"text_with_a_bracket", "keyed(file=a(b)",
       keyed + "file = a(b: expected"},
      {"key_without_a_name", "keyed(=1)", key + "' of term 'keyed': expected"},
      {"key_unknown", "keyed(raech=1)", key + "raech' of term 'keyed': "},
      {"key_of_another_case", "keyed(Reach=1)", key + "Reach' of term"},
      {"key_twice", "keyed(reach=1,reach=2)",
       key + "reach' stands twice in term 'keyed'"},
      {"key_twice_of_a_class", "arap person.arap(weight=1, weight=2)",
       key + "weight' stands twice in term 'arap'"},
      {"key_without_a_value", "keyed(reach)", "--terms: 'reach' in term 'key"},
      {"brackets_that_open_twice", "keyed((reach=1)", key + "(reach' of term"},
      {"brackets_that_stay_open", "keyed(reach=1",
       "'(' of term 'keyed' is not"},
      {"brackets_that_close_twice", "keyed(reach=1))", "term = ''"},
      {"brackets_alone", "(reach=1)", "term = ''"},
      {"a_name_in_utf8", "\xC3\xA4rap(weight=1)", "term = ''"},
      {"a_name_with_nul", std::string("ar\0ap", 5), "term = ar: expected"},
      {"a_very_long_name", std::string(100000, 'a'), "term = aaaa"},
      {"a_very_long_value", "keyed(norm=" + std::string(100000, 'a') + ")",
       keyed + "norm = aaaa"},
      {"very_many_brackets", std::string(100000, '('), "term = ''"},
      {"very_many_dots", "arap " + std::string(100000, '.'), "term = ''"},
      {"classes_of_classes", "arap a.b.arap(weight=1)",
       "'a.b': expected CLASS"},
      {"a_class_without_a_term", "arap person.(weight=1)",
       "--terms: 'person.'"},
      {"a_scale_too_small", "arap(loss=huber,scale=1e-200)",
       "arap.scale = 1e-200: expected metres 1e-100..1e100 with loss huber"},
      {"a_scale_too_large", "arap person.arap(loss=tukey,scale=1e200)",
       "of class person: arap.scale = 1e+200: expected metres 1e-100..1e100"},
      {"no_weight_at_all", "arap(weight=0) keyed(weight=0)",
       "--terms: all weights are 0"},
  };
}

std::string NameOfText(const ::testing::TestParamInfo<RefusedText>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Texts, HostileTexts, ::testing::ValuesIn(Texts()),
                         NameOfText);

TEST(HostileTexts, OneOfTenThousandTermsIsRead) {
  std::string text;
  for (int i = 0; i < 10000; ++i) text += "arap ";
  const Energy energy = ParseEnergy(text, BuiltinTerms());
  EXPECT_EQ(energy.size(), 10000u);
  EXPECT_EQ(TermOptionValues(energy).count("arap.10000.weight"), 1u);
}

TEST(HostileTexts, AClassThatThereIsNotChangesNothingElse) {
  const SurfaceEnergies energies = SurfaceEnergies::Parse(
      "arap(weight=2) unicorn.keyed(weight=3)", WithKeys());
  energies.Check();
  EXPECT_EQ(energies.Of("person").size(), 1u);
  EXPECT_EQ(energies.Of("unicorn").size(), 2u);
  EXPECT_EQ(energies.classes(), std::vector<std::string>{"unicorn"});
}

/// Expects that an energy with a term of this factory is refused.
void ExpectRefusedFactory(const std::string& name,
                          const TermRegistry::Factory& factory,
                          const std::string& message) {
  SCOPED_TRACE(name);
  TermRegistry terms("term");
  terms.Register(name, factory);
  ExpectInputError([&] { MakeTerm(name, terms); }, message);
}

TEST(HostileFactories, AreRefusedByName) {
  const auto good = [] { return std::make_unique<HostileTerm>(); };
  const std::string letters = ": expected letters, digits and _";
  ExpectRefusedFactory("", good, "name of a term = ''" + letters);
  ExpectRefusedFactory("my term", good, "name of a term = my term" + letters);
  ExpectRefusedFactory("arap(weight", good, "= arap(weight" + letters);
  ExpectRefusedFactory("a,b", good, "name of a term = a,b" + letters);
  ExpectRefusedFactory("a.b", good, "name of a term = a.b" + letters);
  ExpectRefusedFactory("\xC3\xA4", good, letters);
  ExpectRefusedFactory(
      "x", [] { return std::unique_ptr<EnergyTerm>(); },
      "term 'x': its factory made nothing");
  ExpectRefusedFactory(
      "x",
      []() -> std::unique_ptr<EnergyTerm> { throw InputError("a.csv: gone"); },
      "term 'x', its factory: a.csv: gone");
  ExpectInputError(
      [&] {
        TermRegistry terms = BuiltinTerms();
        terms.Register("arap", good);
      },
      "term 'arap': already registered");
  TermRegistry terms("term");
  terms.Register("long_" + std::string(10000, 'x'), good);
  EXPECT_NE(MakeTerm(terms.names().front(), terms).term, nullptr);
}

TEST(HostileFactories, WhatTheyThrowIsToldOfThem) {
  const auto thrown = [](const TermRegistry::Factory& factory) -> std::string {
    TermRegistry terms("term");
    terms.Register("x", factory);
    try {
      ParseEnergy("x", terms);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(thrown([]() -> std::unique_ptr<EnergyTerm> { throw 42; }),
            "term 'x', its factory: threw what is no std::exception");
  EXPECT_EQ(thrown(nullptr), "term 'x', its factory: bad_function_call");
  EXPECT_EQ(thrown([] {
              auto term = std::make_unique<HostileTerm>();
              term->list = [](OptionList*) { throw std::bad_alloc(); };
              return term;
            }),
            "term 'x', List(): std::bad_alloc");
  EXPECT_EQ(thrown([] {
              auto term = std::make_unique<HostileTerm>();
              term->list = [](OptionList* list) {
                list->Demand(false, "reach", "more");
              };
              return term;
            }),
            "term 'x', List(): no option x.reach");
}

/// Bytes, or whatever a member is told to throw.
struct HostileState : TermState {
  explicit HostileState(std::string fault, std::string bytes = "kept")
      : fault(std::move(fault)), bytes(std::move(bytes)) {}
  std::string Save() const override {
    if (fault == "Save") throw 42;
    return bytes;
  }
  void Load(const std::string& saved) override {
    bytes = saved;
    if (fault == "Load") throw InputError("expected a number");
  }
  std::string fault, bytes;
};

/// Terms of another class under the same name.
class OtherTerm : public HostileTerm {};

class HostileStates : public ::testing::Test {
 protected:
  template <typename Term = HostileTerm>
  Energy WithState(const std::string& fault) const {
    auto term = std::make_shared<Term>();
    term->new_state = [fault]() -> std::unique_ptr<TermState> {
      if (fault == "NewState") throw std::runtime_error("no memory");
      return std::make_unique<HostileState>(fault);
    };
    term->prepare = [fault](TermState*) {
      if (fault == "Prepare") throw std::runtime_error("no map");
      if (fault == "Prepare number") throw 42;
    };
    return {{{"kept"}, term}};
  }

  void ExpectThrows(const std::function<void()>& action,
                    const std::string& message) const {
    try {
      action();
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::exception& error) {
      EXPECT_EQ(error.what(), message);
    }
  }

  static std::string Saved(TermStates* states) {
    std::ostringstream stream;
    ArchiveWriter archive(&stream);
    archive(*states);
    archive.Flush();
    return stream.str();
  }

  const DeformationGraph graph_ = PlateGraph();
  const std::vector<Correspondence> none_;
  const PinholeCamera camera_;
  const EnergyInput input_{graph_, none_, camera_};
};

TEST_F(HostileStates, WhatTheyThrowIsToldOfTheTerm) {
  TermStates states;
  const auto prepare = [&](const std::string& fault) {
    return [this, &states, fault] { states.Prepare(WithState(fault), input_); };
  };
  ExpectThrows(prepare("NewState"), "term 'kept', NewState(): no memory");
  ExpectThrows(prepare("Prepare"), "term 'kept', Prepare(): no map");
  ExpectThrows(prepare("Prepare number"),
               "term 'kept', Prepare(): threw what is no std::exception");
  TermStates saved;
  saved.Prepare(WithState("Save"), input_);
  ExpectThrows([&] { Saved(&saved); },
               "term 'kept', Save(): threw what is no std::exception");
}

TEST_F(HostileStates, OneThatCannotBeLoadedIsNotHalfKept) {
  TermStates states;
  states.Prepare(WithState(""), input_);
  const std::string saved = Saved(&states);
  std::istringstream stream(saved);
  TermStates restored;
  ArchiveReader archive(&stream, saved.size(), "state");
  archive(restored);
  const Energy faulty = WithState("Load");
  for (int i = 0; i < 2; ++i) {
    ExpectThrows([&] { restored.Prepare(faulty, input_); },
                 "term 'kept', Load(): expected a number");
    EXPECT_EQ(restored.Find(faulty, 0), nullptr);
  }
  EXPECT_EQ(Saved(&restored), saved) << "what was saved is still there";
}

TEST_F(HostileStates, AreOfTheClassThatMadeThem) {
  TermStates states;
  const Energy one = WithState(""), other = WithState<OtherTerm>("");
  states.Prepare(one, input_);
  const TermState* of_one = states.Find(one, 0);
  ASSERT_NE(of_one, nullptr);
  EXPECT_EQ(states.Find(other, 0), nullptr);
  states.Prepare(other, input_);
  EXPECT_EQ(states.Find(one, 0), nullptr);
  EXPECT_NE(states.Find(other, 0), nullptr);
}

/// Deviation of the derivatives of a term, on a plate.
GradientError GradientErrorOf(const std::shared_ptr<HostileTerm>& term) {
  const TriangleMesh mesh = PlateMesh(0.2, 0.1, 0.02, 1);
  const DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  const auto pairs = PerfectAssociation(
      mesh, graph, [](const Eigen::Vector3d& p) { return p; });
  const Energy energy = {{{"hostile"}, term}};
  const PinholeCamera camera;
  return CheckGradients({energy, pairs, camera}, graph).front();
}

TEST(HostileGradients, AreFoundWhereTheyAreWrong) {
  EXPECT_GT(GradientErrorOf(Points(Fault::kWrongSign)).relative, 1);
  EXPECT_GT(GradientErrorOf(Nodes(Fault::kWrongSign)).relative, 1);
  EXPECT_GT(GradientErrorOf(Points(Fault::kOnePerMille)).relative, 5e-4);
  EXPECT_GT(GradientErrorOf(Gains(Fault::kWrongSign, Fault::kNone)).relative,
            1);
  EXPECT_GT(GradientErrorOf(Gains(Fault::kNone, Fault::kWrongSign)).relative,
            1e-4);
  EXPECT_GT(GradientErrorOf(Points(Fault::kNoise)).relative, 1e-3);
  for (const Fault fault :
       {Fault::kNan, Fault::kInfinite, Fault::kNanSlope, Fault::kInfiniteSlope,
        Fault::kNanWithoutSlope, Fault::kHuge, Fault::kRefuses}) {
    EXPECT_GT(GradientErrorOf(OnePoint(fault)).failed, 0)
        << static_cast<int>(fault);
  }
}

TEST(HostileGradients, AreRightWhereNothingIsWrongButTheSize) {
  for (const Fault fault :
       {Fault::kNone, Fault::kSteep, Fault::kFaint, Fault::kConstant}) {
    const GradientError error = GradientErrorOf(Points(fault));
    EXPECT_LT(error.relative, 1e-6) << static_cast<int>(fault);
    EXPECT_EQ(error.failed, 0) << static_cast<int>(fault);
    EXPECT_GT(error.residuals, 0) << static_cast<int>(fault);
  }
  EXPECT_EQ(GradientErrorOf(std::make_shared<HostileTerm>()).residuals, 0);
}

}  // namespace
}  // namespace splitfusion
