// Who holds what: the present holder before others, chains of holders, holders
// that are gone.

#include <gtest/gtest.h>

#include "split/splitter_fixture.h"
#include "splitfusion/lib/split/held_parts.h"

namespace splitfusion {
namespace {

/// A detected card at 2 m.
struct Card {
  std::vector<cv::Rect> rects;
  std::string class_name;
  bool detected = true;
};

class HoldersTest : public SplitterTest {
 protected:
  void Merge(const std::string& groups) {
    SplitOptions options = SceneOptions();
    options.merge_touching = groups;
    UseOptions(options);
  }
  /// A frame of cards; card i has the truth 1 + i.
  void Step(const std::vector<Card>& cards) {
    LayeredScene scene(3.0, next_frame_);
    for (std::size_t i = 0; i < cards.size(); ++i) {
      for (const cv::Rect& rect : cards[i].rects) {
        scene.Add(rect, 2.0, static_cast<int>(i) + 1);
      }
    }
    std::vector<InstanceMask> detections;
    truths_.clear();
    for (std::size_t i = 0; i < cards.size(); ++i) {
      truths_.push_back(scene.Truth(static_cast<int>(i) + 1));
      if (!cards[i].detected) continue;
      detections.push_back({truths_.back(), cards[i].class_name, 0.9});
    }
    Split(scene, detections);
  }
  int HolderOf(int id) const { return splitter_.instances().at(id).held_by; }
  std::string ClassOf(int id) const {
    return splitter_.instances().at(id).class_name;
  }
  std::vector<cv::Mat_<uchar>> truths_;
};

const Card kToy{{{70, 60, 28, 28}}, "teddy bear"};

/// Left of the toy; `away`: so many pixels from it.
Card Left(int away) { return {{{30 - away, 25, 40, 80}}, "person"}; }

/// Right of the toy and below it: touches more of it than who is left.
Card Right(int away) {
  return {{{98 + away, 25, 30, 80}, {70 + away, 88 + away, 28, 17}}, "person"};
}

class TwoHoldersTest : public HoldersTest,
                       public testing::WithParamInterface<bool> {
 protected:
  TwoHoldersTest() { Merge("person+teddy bear"); }
  /// `left`, `right`: how far the two are from the toy, the one before or after
  /// the other in the list of detections.
  void StepTwo(int left, int right) {
    if (GetParam()) {
      Step({Left(left), Right(right), kToy});
    } else {
      Step({Right(right), Left(left), kToy});
    }
  }
  int left() const { return GetParam() ? 1 : 2; }
  int right() const { return GetParam() ? 2 : 1; }
};

TEST_P(TwoHoldersTest, WhoHoldsItKeepsItWhileOthersTouchItMore) {
  for (int i = 0; i < 3; ++i) StepTwo(0, 8);
  ASSERT_EQ(HolderOf(3), left());
  for (int i = 0; i < 8; ++i) {
    StepTwo(0, 0);
    EXPECT_EQ(HolderOf(3), left()) << i;
    EXPECT_GT(IouOf(left(), truths_[left() - 1] | truths_[2]), 0.9) << i;
  }
}

TEST_P(TwoHoldersTest, WithoutAHolderTheLongestBorderDecides) {
  for (int i = 0; i < 2; ++i) StepTwo(0, 0);
  EXPECT_EQ(HolderOf(3), right());
}

TEST_P(TwoHoldersTest, ItIsHandedOverAfterSeveralFramesWithoutContact) {
  for (int i = 0; i < 3; ++i) StepTwo(0, 8);
  for (int i = 0; i < 12; ++i) {
    StepTwo(i % 4 == 3 ? 8 : 0, 0);
    EXPECT_EQ(HolderOf(3), left()) << i;
  }
  int frames = 0;
  while (HolderOf(3) == left() && frames < 20) StepTwo(8, 0), ++frames;
  EXPECT_EQ(HolderOf(3), right());
  EXPECT_EQ(frames, 4);  // One was among those before.
  EXPECT_GT(IouOf(right(), truths_[right() - 1] | truths_[2]), 0.9);
}

INSTANTIATE_TEST_SUITE_P(EitherOrder, TwoHoldersTest, testing::Bool());

/// From left to right: a person, a bag, a toy, each beside the other.
Card Person() { return {{{15, 20, 40, 85}}, "person"}; }
Card Bag(int x = 55) { return {{{x, 45, 30, 34}}, "handbag"}; }
Card Toy(int x = 85) { return {{{x, 45, 30, 30}}, "teddy bear"}; }

TEST_F(HoldersTest, WhatIsOnWhatIsHeldBelongsToTheWhole) {
  Merge("person+handbag,handbag+teddy bear");
  for (int i = 0; i < 4; ++i) {
    Step({Person(), Bag(), Toy()});
    EXPECT_GT(IouOf(1, truths_[0] | truths_[1] | truths_[2]), 0.95) << i;
    EXPECT_EQ(Count("merged"), 2) << i;
    for (const SplitDecision& decision : last_.decisions) {
      const bool merged = decision.action == "merged";
      EXPECT_TRUE(!merged || decision.surface == 1) << i;
    }
  }
  EXPECT_EQ(ClassOf(HolderOf(3)), "handbag");
  EXPECT_EQ(ClassOf(HolderOf(2)), "person");
  // The bag is put down with the toy.
  for (int i = 0; i < 8; ++i) Step({Person(), Bag(63), Toy(93)});
  EXPECT_GT(IouOf(1, truths_[0]), 0.95);
  EXPECT_GT(IouOf(2, truths_[1] | truths_[2]), 0.95);
  // And taken up again.
  for (int i = 0; i < 3; ++i) Step({Person(), Bag(), Toy()});
  EXPECT_GT(IouOf(1, truths_[0] | truths_[1] | truths_[2]), 0.95);
}

TEST_F(HoldersTest, ChainsAreFollowedThroughMissedDetections) {
  Merge("person+handbag,handbag+teddy bear");
  for (int i = 0; i < 4; ++i) Step({Person(), Bag(), Toy()});
  for (int i = 0; i < 6; ++i) {
    Card bag = Bag(), toy = Toy();
    bag.detected = i % 2 == 0;
    toy.detected = i % 3 == 0;
    Step({Person(), bag, toy});
    EXPECT_GT(IouOf(1, truths_[0] | truths_[1] | truths_[2]), 0.95) << i;
  }
  EXPECT_EQ(splitter_.instances().size(), 3u);
}

TEST_F(HoldersTest, AChainIsNoGroupOfItsEnds) {
  Merge("person+handbag,handbag+teddy bear");
  for (int i = 0; i < 4; ++i) Step({Person(), Toy(55)});
  EXPECT_GT(IouOf(1, truths_[0]), 0.95);
  EXPECT_GT(IouOf(2, truths_[1]), 0.9);
  EXPECT_EQ(HolderOf(2), 0);
}

TEST_F(HoldersTest, NothingHoldsWhatItIsHeldBy) {
  Merge("person+teddy bear,teddy bear+person");
  for (int i = 0; i < 4; ++i) {
    Step({Person(), Toy(55)});
    EXPECT_EQ(Count("merged"), 1) << i;
    EXPECT_NE(HolderOf(1) == 2, HolderOf(2) == 1) << i;
  }
}

TEST_F(HoldersTest, WhoIsGivenUpHoldsNothing) {
  Merge("person+teddy bear");
  Card person = Person();
  for (int i = 0; i < 4; ++i) Step({person, Toy(55)});
  ASSERT_EQ(HolderOf(2), 1);
  person.detected = false;  // Stands there all the same.
  int missed = 0;
  while (!splitter_.instances().at(1).dormant && missed < 30) {
    Step({person, Toy(55)});
    ++missed;
  }
  EXPECT_EQ(missed, SceneOptions().max_missed_frames + 1);
  EXPECT_EQ(HolderOf(2), 0);
  EXPECT_GT(IouOf(2, truths_[1]), 0.9);
  Step({person, Toy(55)});
  EXPECT_EQ(HolderOf(2), 0);
}

TEST_F(HoldersTest, APartInTwoPiecesIsOnePart) {
  Merge("person+teddy bear");
  for (int i = 0; i < 4; ++i) Step({Person(), Toy(55)});
  // Of an arm that comes into view the detector makes a toy of its own.
  const Card arm{{{55, 20, 20, 25}}, "teddy bear"};
  Step({Person(), Toy(55), arm});
  int held = 0;
  for (const SplitDecision& decision : last_.decisions) {
    held += decision.action == "merged" && decision.surface == 1;
  }
  EXPECT_EQ(held, 1);
  EXPECT_GT(IouOf(1, truths_[0] | truths_[1] | truths_[2]), 0.95);
  EXPECT_EQ(splitter_.instances().size(), 2u);
}

}  // namespace
}  // namespace splitfusion
