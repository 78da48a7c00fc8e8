#include "splitfusion/lib/base/option_list.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

struct PartOptions {
  double near = 0.1, far = 2;
  bool fast = true;

  void List(OptionList* list) {
    list->Number("near", &near, Range::Above(0), "metres", "Where it begins.");
    list->Number("far", &far, {0, 10, false, true}, "metres", "Where it ends.")
        .common = true;
    list->Demand(far > near, "far", "metres > near");
    list->Switch("fast", &fast, "Do less.");
  }
};

struct WholeOptions {
  PartOptions left, right;
  int count = 3;
  std::string kind = "a", note;

  void List(OptionList* list) {
    list->Number("count", &count, {1, 8}, "", "How many.");
    list->Choice("kind", &kind, {"a", "b", "c"}, "Which.");
    list->Text("note", &note, "Anything.");
    list->Part("left_", &left);
    list->Part("right_", &right);
  }
};

TEST(OptionList, HoldsTheFieldsOfAllPartsByName) {
  WholeOptions options;
  OptionList list;
  options.List(&list);
  std::string names;
  for (const Option& option : list.options()) names += option.name + " ";
  EXPECT_EQ(names,
            "count kind note left_near left_far left_fast right_near right_far "
            "right_fast ");
  EXPECT_FALSE(list.options()[3].common);
  EXPECT_TRUE(list.options()[4].common);
  EXPECT_EQ(std::get<double*>(list.options()[6].value), &options.right.near);
  EXPECT_EQ(list.options()[3].ValueText(), "0.1");
  EXPECT_EQ(list.options()[5].ValueText(), "true");
  EXPECT_EQ(list.options()[0].ValueText(), "3");
  EXPECT_EQ(list.options()[1].Expected(), "a, b or c");
  EXPECT_EQ(list.options()[4].Expected(), "0..10 metres, not 10");
}

template <typename Set>
void ExpectRefused(Set set, const std::string& message) {
  WholeOptions options;
  set(&options);
  ExpectInputError([&] { CheckOptions(options); }, message);
}

TEST(OptionList, NamesTheOptionTheValueAndTheRange) {
  EXPECT_NO_THROW(CheckOptions(WholeOptions()));
  ExpectRefused([](auto* o) { o->count = 0; }, "count = 0: expected 1..8");
  ExpectRefused([](auto* o) { o->kind = "d"; }, "kind = d: expected a, b or c");
  ExpectRefused([](auto* o) { o->left.near = 0; },
                "left_near = 0: expected metres > 0");
  ExpectRefused([](auto* o) { o->right.far = 10; },
                "right_far = 10: expected 0..10 metres, not 10");
  ExpectRefused([](auto* o) { o->right.near = std::nan(""); },
                "right_near = nan: expected metres > 0");
  ExpectRefused([](auto* o) { o->right.far = INFINITY; }, "right_far = inf");
}

TEST(OptionList, ADemandNamesItsOption) {
  ExpectRefused([](auto* o) { o->right.near = 5; },
                "right_far = 2: expected metres > near");
}

TEST(Option, ReadsItsValueFromText) {
  WholeOptions options;
  OptionList list;
  options.List(&list);
  std::vector<Option> all = list.options();
  const auto set = [&](int i, const std::string& text) { all[i].Set(text); };
  set(0, "7");
  set(1, "c");
  set(2, "a note");
  set(3, "2.5e-1");
  set(5, "false");
  EXPECT_EQ(options.count, 7);
  EXPECT_EQ(options.kind, "c");
  EXPECT_EQ(options.note, "a note");
  EXPECT_EQ(options.left.near, 0.25);
  EXPECT_FALSE(options.left.fast);
  const auto refuse = [&](int i, const std::string& text,
                          const std::string& expected) {
    ExpectInputError([&] { set(i, text); },
                     all[i].name + " = " + text + ": expected " + expected);
  };
  for (const char* text : {"9", "7.5", "7x", "", "seven", "99999999999"}) {
    refuse(0, text, "1..8");
  }
  refuse(1, "d", "a, b or c");
  for (const char* text : {"0", "nan", "inf", "1e999", "0.1 ", "0,1"}) {
    refuse(3, text, "metres > 0");
  }
  refuse(5, "1", "true or false");
  EXPECT_EQ(options.count, 7) << "what is refused changes nothing";
  EXPECT_EQ(options.kind, "c");
  EXPECT_EQ(options.left.near, 0.25);
}

TEST(Range, SaysWhatItHolds) {
  EXPECT_EQ(Range().Text(), "a number");
  EXPECT_EQ(Range::AtLeast(2).Text(), ">= 2");
  EXPECT_EQ(Range::AtLeast(2).Text("frames"), "frames >= 2");
  EXPECT_EQ(Range::Share().Text(), "0..1");
  Range below;
  below.high = 1;
  below.below_high = true;
  EXPECT_EQ(below.Text(), "< 1");
  EXPECT_TRUE(below.Holds(-1e9));
  EXPECT_FALSE(below.Holds(1));
  EXPECT_FALSE(below.Holds(-INFINITY));
}

}  // namespace
}  // namespace splitfusion
