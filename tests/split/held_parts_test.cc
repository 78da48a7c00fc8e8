// A person with what the person holds is one surface while the two touch.

#include "splitfusion/lib/split/held_parts.h"

#include "split/splitter_fixture.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

const cv::Rect kPerson(40, 25, 40, 80);
const cv::Rect kHeld(80, 45, 28, 28);  // Touches the person.
constexpr double kDepth = 2.0;         // Of the person, metres.

class HeldPartsTest : public SplitterTest {
 protected:
  HeldPartsTest() { Merge("person+teddy bear,person+suitcase"); }
  void Merge(const std::string& groups) {
    SplitOptions options = SceneOptions();
    options.merge_touching = groups;
    UseOptions(options);
  }
  struct Toy {
    cv::Rect rect = kHeld;
    double depth = kDepth;
    bool detected = true;
    std::string class_name = "teddy bear";
  };
  /// A frame with person and toy.
  void Step(const Toy& toy, const SurfacePrediction& prediction = {}) {
    LayeredScene scene(3.0, next_frame_);
    scene.Add(kPerson, kDepth, 1).Add(toy.rect, toy.depth, 2);
    person_ = scene.Truth(1);
    toy_ = scene.Truth(2);
    std::vector<InstanceMask> detections = {{person_, "person", 0.9}};
    if (toy.detected) detections.push_back({toy_, toy.class_name, 0.8});
    Split(scene, detections, prediction);
  }
  /// What a tracker predicts that knows both as surface 1.
  SurfacePrediction Whole() const {
    SurfacePrediction prediction{LabelImage(120, 160, std::uint16_t(0)),
                                 cv::Mat_<float>(120, 160, 3.0f),
                                 cv::Mat_<float>(120, 160, 3.0f)};
    const cv::Mat whole = RectMask(kPerson) | RectMask(kHeld);
    prediction.labels.setTo(1, whole);
    prediction.depth.setTo(kDepth, whole);
    return prediction;
  }
  void ExpectOneSurface(const std::string& when) const {
    EXPECT_GT(IouOf(1, person_ | toy_), 0.96) << when;
    double highest = 0;
    cv::minMaxLoc(last_.labels, nullptr, &highest);
    EXPECT_EQ(highest, 1) << when;
  }
  void ExpectTwoSurfaces(int toy_id) const {
    EXPECT_GT(IouOf(1, person_), 0.96);
    EXPECT_GT(IouOf(toy_id, toy_), 0.9);
  }
  cv::Mat_<uchar> person_, toy_;
};

TEST_F(HeldPartsTest, WhatTouchesThePersonIsThePersonFromTheFirstFrame) {
  for (int i = 0; i < 5; ++i) {
    Step({});
    ExpectOneSurface("frame " + std::to_string(i));
  }
  EXPECT_EQ(splitter_.tracks().at(1).class_name, "person");
}

TEST_F(HeldPartsTest, WhatIsInFrontOfThePersonIsASurfaceOfItsOwn) {
  for (int i = 0; i < 5; ++i) Step({kHeld, 1.6});
  ExpectTwoSurfaces(2);
}

TEST_F(HeldPartsTest, WithoutTheOptionTheyAreTwo) {
  Merge("");
  for (int i = 0; i < 5; ++i) Step({});
  ExpectTwoSurfaces(2);
}

TEST_F(HeldPartsTest, WhatIsTakenUpIsHeldThroughMissedDetections) {
  for (int x = 110; x > 80; x -= 5) Step({{x, 45, 28, 28}});
  ExpectTwoSurfaces(2);
  for (int i = 0; i < 3; ++i) Step({});
  ExpectOneSurface("touching");
  EXPECT_FALSE(splitter_.tracks().at(2).followed());
  for (int i = 0; i < 12; ++i) {
    Step({kHeld, kDepth, /*detected=*/false});
    ExpectOneSurface("missed " + std::to_string(i));
  }
  Step({});
  ExpectOneSurface("detected again");
  EXPECT_EQ(splitter_.tracks().size(), 2u);
}

TEST_F(HeldPartsTest, WhatIsTakenUpAndPutDownKeepsItsId) {
  for (int i = 0; i < 3; ++i) Step({{110, 45, 28, 28}});
  for (int i = 0; i < 6; ++i) Step({});
  for (int i = 0; i < 4; ++i) Step({{100, 60, 28, 28}});
  ExpectTwoSurfaces(2);
  EXPECT_EQ(splitter_.tracks().size(), 2u);
}

TEST_F(HeldPartsTest, AMomentWithoutContactMakesNoSurface) {
  for (int i = 0; i < 20; ++i) {
    Step({i % 4 == 3 ? cv::Rect(90, 45, 28, 28) : kHeld});
    EXPECT_GT(IouOf(1, person_), 0.7) << i;
  }
  EXPECT_EQ(splitter_.tracks().size(), 1u);
}

TEST_F(HeldPartsTest, WhatATrackerKnowsAsOneStillComesApart) {
  for (int i = 0; i < 3; ++i) Step({});
  for (int i = 0; i < 5; ++i) {
    Step({}, Whole());
    ExpectOneSurface(std::to_string(i));
  }
  // Put down just beside, where the model of the whole still has it.
  for (int i = 0; i < 8; ++i) Step({{86, 45, 28, 28}}, Whole());
  ExpectTwoSurfaces(2);
}

TEST_F(HeldPartsTest, RigidThingsAreHeldTooAndBackgroundOtherwise) {
  Toy suitcase;
  suitcase.class_name = "suitcase";
  suitcase.rect.x += 20;
  for (int i = 0; i < 5; ++i) {
    Step(suitcase);
    EXPECT_GT(IouOf(1, person_), 0.96) << i;
    EXPECT_EQ(Count("ignored"), 1) << i;
  }
  EXPECT_EQ(splitter_.tracks().size(), 1u);
  EXPECT_EQ(cv::countNonZero(last_.uncertain & RectMask({108, 50, 15, 20})), 0);
  suitcase.rect = kHeld;
  for (int i = 0; i < 5; ++i) Step(suitcase);
  ExpectOneSurface("held");
}

TEST_F(HeldPartsTest, APersonTakenForAToyIsNoToy) {
  for (int i = 0; i < 12; ++i) {
    LayeredScene scene(3.0, i);
    scene.Add(kPerson, kDepth, 1);
    std::vector<InstanceMask> detections;
    if (i % 3 != 1) detections.push_back({scene.Truth(1), "person", 0.9});
    if (i % 3 != 0) detections.push_back({scene.Truth(1), "teddy bear", 0.6});
    Split(scene, detections);
    EXPECT_GT(IouOf(1, scene.Truth(1)), 0.96) << i;
  }
  EXPECT_EQ(splitter_.tracks().size(), 1u);
  EXPECT_EQ(splitter_.tracks().at(1).class_name, "person");
}

/// Detections of a person, a bag and a toy side by side, in contact or not.
class JoinHeldPartsTest : public testing::Test {
 protected:
  JoinedDetections Join(const std::string& groups, int bag_x, int toy_x) {
    LayeredScene scene;
    scene.Add({20, 20, 40, 80}, 2, 1);
    scene.Add({bag_x, 40, 30, 30}, 2, 2);
    scene.Add({toy_x, 45, 20, 20}, 2, 3);
    const Frame frame = scene.MakeFrame(0);
    for (const int id : {1, 2, 3}) masks_[id] = scene.Truth(id);
    return JoinHeldParts({{masks_[1], "person", 0.9},
                          {masks_[2], "handbag", 0.8},
                          {masks_[3], "toy", 0.7}},
                         ParseMergeGroups(groups),
                         ComputePointMap(frame.depth, SceneCamera()));
  }
  std::map<int, cv::Mat_<uchar>> masks_;
};

TEST_F(JoinHeldPartsTest, WhatIsOnWhatIsHeldBelongsToTheWhole) {
  const JoinedDetections joined =
      Join("person+handbag,handbag+toy", /*bag_x=*/60, /*toy_x=*/90);
  ASSERT_EQ(joined.detections.size(), 1u);
  EXPECT_EQ(joined.detections[0].class_name, "person");
  const cv::Mat all = masks_[1] | masks_[2] | masks_[3];
  EXPECT_EQ(cv::countNonZero(joined.detections[0].mask != all), 0);
  EXPECT_EQ(joined.held.size(), 2u);
}

TEST_F(JoinHeldPartsTest, AChainIsNoGroupOfItsEnds) {
  EXPECT_EQ(Join("person+handbag", 60, 90).detections.size(), 2u);
  EXPECT_EQ(Join("person+handbag,handbag+toy", 120, 60).detections.size(), 3u);
}

TEST_F(JoinHeldPartsTest, WhatIsApartStaysApart) {
  EXPECT_EQ(Join("person+handbag,handbag+toy", 70, 110).detections.size(), 3u);
}

TEST_F(JoinHeldPartsTest, TwoThatMayHoldEachOtherAreOne) {
  const JoinedDetections joined =
      Join("person+handbag,handbag+person", 60, 120);
  EXPECT_EQ(joined.detections.size(), 2u);
  EXPECT_EQ(joined.held.size(), 1u);
}

TEST(MergeGroups, AreReadFromText) {
  const auto groups =
      ParseMergeGroups("person+teddy bear, person + handbag +tie,cat+mouse");
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[1].held, (std::set<std::string>{"handbag", "tie"}));
  EXPECT_TRUE(MayHold(groups, "person", "teddy bear"));
  EXPECT_TRUE(MayHold(groups, "cat", "mouse"));
  EXPECT_FALSE(MayHold(groups, "teddy bear", "person"));
  EXPECT_FALSE(MayHold(groups, "cat", "tie"));
  EXPECT_TRUE(MayBeHeld(groups, "tie"));
  EXPECT_FALSE(MayBeHeld(groups, "person"));
  EXPECT_TRUE(ParseMergeGroups("").empty());
}

TEST(MergeGroups, NameWhatDoesNotParse) {
  for (const std::string text :
       {"person", "person+", "+teddy bear", " ", "person+teddy bear,",
        "a+b,,c+d", "a+a", "a+b+b"}) {
    ExpectInputError([&] { ParseMergeGroups(text); },
                     "merge_touching = " + text + ": expected entries of at");
  }
}

TEST(SplitOptions, RigidObjectsIsOneOfTwoWords) {
  SplitOptions options;
  options.rigid_objects = "true";
  ExpectInputError([&] { options.Check(); },
                   "rigid_objects = true: expected background or separate");
  options.rigid_objects = "separate";
  EXPECT_NO_THROW(options.Check());
}

TEST(TakeOutOthers, NothingIsPredictedWhereSomebodyElseIsKnownToBe) {
  TrackTable tracks;
  for (const int identity : {10, 20}) {
    const int id = AddTrack(0, "person", SurfaceKind::kNonRigid, &tracks);
    tracks.at(id).appearance.identity = identity;
  }
  ComparedDepth compared;
  compared.labels = (LabelImage(1, 4) << 1, 1, 2, 0);
  compared.agreement = cv::Mat_<uchar>(1, 4, uchar(DepthState::kObserved));
  Candidate own;
  own.mask = cv::Mat_<uchar>(1, 4, uchar(255));
  const LabelImage before = compared.labels.clone();
  TakeOutOthers({own}, tracks, &compared);  // Without an identity.
  EXPECT_EQ(cv::countNonZero(compared.labels != before), 0);
  own.appearance.identity = 20;
  TakeOutOthers({own}, tracks, &compared);
  EXPECT_EQ(compared.labels(0, 0), 0);
  EXPECT_EQ(compared.labels(0, 1), 0);
  EXPECT_EQ(compared.labels(0, 2), 2);
  EXPECT_EQ(compared.agreement(0, 0), uchar(DepthState::kUnmeasured));
  EXPECT_EQ(compared.agreement(0, 2), uchar(DepthState::kObserved));
}

}  // namespace
}  // namespace splitfusion
