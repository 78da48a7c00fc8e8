#include "splitfusion/lib/model/hidden_motions.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "splitfusion/lib/model/hidden_window.h"
#include "splitfusion/lib/model/part_motions.h"
#include "support/expect_input_error.h"
#include "support/hidden_plate.h"
#include "support/motion_frames.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

bool All(int /*node*/) { return true; }

/// Rotations count by what they move half a metre away.
constexpr double kHalfMetre = 0.5;

double FarthestNode(const SurfaceModel& a, const SurfaceModel& b) {
  double farthest = 0;
  for (int f = 0; f < a.history.size(); ++f) {
    const FrameMotions of_a = a.history.At(f), of_b = b.history.At(f);
    for (std::size_t i = 0; i < of_a.motions.size(); ++i) {
      const NodeMotion& one = of_a.motions[i];
      const NodeMotion& other = of_b.motions[i];
      farthest =
          std::max(farthest, (one.translation - other.translation).norm());
      farthest = std::max(farthest,
                          kHalfMetre * (one.rotation - other.rotation).norm());
    }
  }
  return farthest;
}

TEST(HiddenMotions, OfWhatWalksOnUnseenAreThoseOfItsWay) {
  const auto poses = Poses(FramesUpTo(30));
  const SurfaceModel truth = SeenPlate(poses, Walk);
  SurfaceModel model = truth;
  Hide(10, 24, All, &model);
  ASSERT_GT(FarthestNode(model, truth), 0.2);
  const std::vector<RefinedWindow> windows =
      RefineHiddenMotions(poses, {}, &model);
  EXPECT_LT(FarthestNode(model, truth), 0.005);
  ASSERT_EQ(windows.size(), 1u);
  EXPECT_EQ(windows[0].hidden, 15 * model.graph.size());
  EXPECT_TRUE(windows[0].solved);
  EXPECT_EQ(windows[0].first_frame, 0);
  EXPECT_EQ(windows[0].last_frame, 30);
  EXPECT_LT(windows[0].final.smoothness, 0.1 * windows[0].initial.smoothness);
}

TEST(HiddenMotions, OfWhatTurnsUnseenTurnWithIt) {
  const auto poses = Poses(FramesUpTo(30));
  const SurfaceModel truth = SeenPlate(poses, [](const Eigen::Vector3d& p,
                                                 int frame) {
    const Eigen::Vector3d center(0, 0, 1);
    return Eigen::Vector3d(
        MakeMotion({0, 0.04 * frame, 0}, {0.01 * frame, 0, 0}) * (p - center) +
        center);
  });
  SurfaceModel model = truth;
  Hide(8, 22, All, &model);
  RefineHiddenMotions(poses, {}, &model);
  EXPECT_LT(FarthestNode(model, truth), 0.01);
  for (int f = 0; f < truth.history.size(); ++f) {
    EXPECT_LT(
        RotationAngle(model.history.At(f).motions[0].rotation.transpose() *
                      truth.history.At(f).motions[0].rotation),
        0.03);
  }
}

TEST(HiddenMotions, OfAPartGoOnWithWhatIsSeenBesideIt) {
  const auto poses = Poses(FramesUpTo(30));
  const SurfaceModel truth = SeenPlate(poses, Walk);
  SurfaceModel model = truth;
  const auto is_right = [&](int i) {
    return model.graph.positions[i].x() > 0.05;
  };
  Hide(10, 24, is_right, &model);
  RefineHiddenMotions(poses, {}, &model);
  EXPECT_LT(FarthestNode(model, truth), 0.005);
}

TEST(HiddenMotions, WhatWasSeenKeepsItsBits) {
  const auto poses = Poses(FramesUpTo(30));
  SurfaceModel model = SeenPlate(poses, Walk);
  Hide(10, 24, All, &model);
  const SurfaceModel before = model;
  RefineHiddenMotions(poses, {}, &model);
  for (int f = 0; f < before.history.size(); ++f) {
    const FrameMotions frame = before.history.At(f);
    const std::vector<NodeMotion> after = model.history.At(f).motions;
    for (int i = 0; i < model.graph.size(); ++i) {
      EXPECT_EQ(frame.Saw(i),
                after[i].translation == frame.motions[i].translation &&
                    after[i].rotation == frame.motions[i].rotation)
          << frame.frame;
    }
  }
}

TEST(HiddenMotions, BeforeTheFirstAndAfterTheLastSightStayAsTheyAre) {
  const auto poses = Poses(FramesUpTo(30));
  SurfaceModel model = SeenPlate(poses, Walk);
  const auto hide = [](FrameMotions& frame) {
    frame.seen.assign(frame.seen.size(), false);
  };
  EditFrames(
      [&](FrameMotions& frame) {
        if (frame.frame < 5 || frame.frame > 20) hide(frame);
      },
      &model.history);
  const SurfaceModel before = model;
  EXPECT_TRUE(RefineHiddenMotions(poses, {}, &model).empty());
  EXPECT_EQ(FarthestNode(model, before), 0);
  EditFrames([](FrameMotions& frame) { frame.seen.clear(); }, &model.history);
  EXPECT_TRUE(RefineHiddenMotions(poses, {}, &model).empty());
  EXPECT_EQ(FarthestNode(model, before), 0) << "never seen";
}

TEST(HiddenMotions, BeforeTheFirstSightStayWhereNothingWasSeenAtFirst) {
  const auto poses = Poses(FramesUpTo(30));
  SurfaceModel model = SeenPlate(poses, Walk);
  EditFrames(
      [](FrameMotions& frame) {
        if (frame.frame < 3) frame.seen.assign(frame.seen.size(), false);
        if (frame.frame < 15) frame.seen[0] = false;
      },
      &model.history);
  const SurfaceModel before = model;
  EXPECT_TRUE(RefineHiddenMotions(poses, {}, &model).empty());
  EXPECT_EQ(FarthestNode(model, before), 0);
}

TEST(HiddenMotions, OfNodesNeverSeenAgainStayAsTheyWereTracked) {
  const auto poses = Poses(FramesUpTo(30));
  SurfaceModel model = SeenPlate(poses, Walk);
  const auto is_right = [&](int i) {
    return model.graph.positions[i].x() > 0.05;
  };
  Hide(10, 30, is_right, &model);
  Hide(15, 20, All, &model);
  const SurfaceModel before = model;
  RefineHiddenMotions(poses, {}, &model);
  for (int f = 0; f < before.history.size(); ++f) {
    for (int i = 0; i < model.graph.size(); ++i) {
      const int frame = before.history.frame(f);
      const bool nothing_is_seen = frame >= 15 && frame <= 20;
      EXPECT_EQ(nothing_is_seen,
                model.history.At(f).motions[i].translation !=
                    before.history.At(f).motions[i].translation);
    }
  }
}

TEST(HiddenMotions, OfARigidSurfaceAreThoseOfItsMiddle) {
  std::map<int, Rigid3d> poses;
  for (const int frame : FramesUpTo(20)) poses[frame] = Rigid3d::Identity();
  const auto motion = [](int frame) {
    return MakeMotion({0, 0, 0.03 * frame}, {0.02 * frame, 0, 0});
  };
  SurfaceModel model;
  model.mesh = PlateMesh(0.3, 0.2, 0.02, 1);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& v : model.mesh.vertices) {
    middle += v.cast<double>() / model.mesh.vertices.size();
  }
  for (const auto& [frame, pose] : poses) {
    const Rigid3d placed = Eigen::Translation3d(middle) * motion(frame) *
                           Eigen::Translation3d(-middle);
    model.graph = MakeRigidGraph(placed);
    model.history.Append({frame, true, model.graph.motions, {1}});
  }
  const SurfaceModel truth = model;
  Hide(6, 15, All, &model);
  RefineHiddenMotions(poses, {}, &model);
  EXPECT_LT(FarthestNode(model, truth), 1e-3);
}

TEST(HiddenMotions, OfALongStretchGoOverFromSightToSight) {
  const auto poses = Poses(FramesUpTo(110));
  const SurfaceModel truth =
      SeenPlate(poses, [](const Eigen::Vector3d& p, int frame) {
        return Eigen::Vector3d(p + Eigen::Vector3d(0.02 * frame, 0, 0));
      });
  SurfaceModel model = truth;
  Hide(10, 99, All, &model);
  // As a camera that follows it would: it ran off in the frame before.
  EditFrame(
      9,
      [](FrameMotions& frame) {
        for (NodeMotion& m : frame.motions) m.translation.x() += 0.01;
      },
      &model.history);
  RefineHiddenMotions(poses, {}, &model);
  EXPECT_LT(FarthestNode(model, truth), 0.15) << "not 90 times as far";
}

TEST(HiddenMotions, FramesLeftOutCountByTime) {
  std::vector<int> frames = FramesUpTo(10);
  for (int frame = 14; frame <= 40; frame += 3) frames.push_back(frame);
  const auto poses = Poses(frames);
  const SurfaceModel truth =
      SeenPlate(poses, [](const Eigen::Vector3d& p, int frame) {
        return Eigen::Vector3d(p + Eigen::Vector3d(0.02 * frame, 0, 0));
      });
  SurfaceModel model = truth;
  Hide(8, 29, All, &model);
  RefineHiddenMotions(poses, {}, &model);
  EXPECT_LT(FarthestNode(model, truth), 0.02);
}

TEST(HiddenMotions, PartsAreFoundInTheirFramesAlone) {
  const auto poses = Poses(FramesUpTo(30));
  SurfaceModel first = SeenPlate(poses, Walk);
  first.history = Frames(first.history, 0, 20);
  const SurfaceModel whole = first;
  Hide(5, 12, All, &first);
  SurfaceModel second = SeenPlate(poses, Walk);
  second.history = Frames(second.history, 20, second.history.size());
  const SurfaceModel truth = JoinModels({whole, second});
  Hide(24, 26, All, &second);
  SurfaceModel joined = JoinModels({first, second});
  ASSERT_GT(FarthestNode(joined, truth), 0.05);
  const std::vector<RefinedWindow> windows =
      RefineHiddenMotions(poses, {}, &joined);
  ASSERT_EQ(windows.size(), 2u);
  EXPECT_EQ(windows[0].part, 0);
  EXPECT_EQ(windows[0].hidden, 8 * first.graph.size());
  EXPECT_EQ(windows[0].kept, windows[0].hidden);
  EXPECT_EQ(windows[0].last_frame, 19);
  EXPECT_EQ(windows[1].part, 1);
  EXPECT_EQ(windows[1].hidden, 3 * second.graph.size());
  EXPECT_LT(FarthestNode(joined, truth), 0.01);
}

TEST(HiddenMotions, OfRefutedPartsStayAsTheyWereTracked) {
  const auto poses = Poses(FramesUpTo(30));
  SurfaceModel part = SeenPlate(poses, Walk), rest = part;
  part.history = Frames(part.history, 0, 20);
  Hide(5, 12, All, &part);
  Hide(5, 12, All, &rest);
  SurfaceModel joined = JoinModels({part, rest});
  const SurfaceModel before = joined;
  const std::vector<RefinedWindow> windows =
      RefineHiddenMotions(poses, {}, &joined);
  ASSERT_EQ(windows.size(), 1u);
  EXPECT_EQ(windows[0].part, 1);
  for (const FrameMotions& frame : joined.history) {
    if (frame.frame >= 20) continue;
    for (int i = 0; i < part.graph.size(); ++i) {
      EXPECT_EQ(frame.Of(i).translation,
                before.history.Find(frame.frame)->Of(i).translation);
    }
  }
  EXPECT_GT(FarthestNode(joined, before), 0.05);
}

TEST(HiddenMotions, ShortWindowsAgreeWithLongOnes) {
  const auto poses = Poses(FramesUpTo(60));
  const SurfaceModel truth = SeenPlate(poses, Walk);
  SurfaceModel model = truth;
  Hide(5, 10, All, &model);
  Hide(30, 36, All, &model);
  SurfaceModel other = model;
  HiddenMotionOptions options;
  options.window = 100;
  RefineHiddenMotions(poses, options, &model);
  options.window = 32;
  const std::vector<RefinedWindow> windows =
      RefineHiddenMotions(poses, options, &other);
  EXPECT_GT(windows.size(), 1u);
  EXPECT_LT(FarthestNode(model, other), 2e-3);
  EXPECT_LT(FarthestNode(other, truth), 5e-3);
}

TEST(PartFrames, HoldsThoseInHandAlone) {
  const auto poses = Poses(FramesUpTo(600));
  SurfaceModel model = SeenPlate(poses, Walk);
  // Some windows have nothing hidden, and are passed over.
  for (int f = 10; f < 590; f += 100) Hide(f, f + 3, All, &model);
  const std::vector<Eigen::Vector3d> centers = CentersOf(model);
  const PartFrames frames(0, centers, poses, model);
  PartMotions motions = frames.motions();
  int windows = 0;
  WindowHooks hooks;
  hooks.begins = [&](int begin, int end) {
    frames.Load(begin, end, &motions);
    int in_hand = 0;
    for (const auto& states : motions.states) {
      EXPECT_EQ(states.empty(), states.capacity() == 0);
      in_hand += !states.empty();
    }
    EXPECT_EQ(in_hand, end - begin);
    ++windows;
  };
  RefinePart({}, {}, &motions, hooks);
  EXPECT_GT(windows, 5);
}

TEST(HiddenMotions, DoNotDependOnWhereTheFramesLie) {
  const auto poses = Poses(FramesUpTo(110));
  SurfaceModel model = SeenPlate(poses, Walk);
  Hide(5, 40, All, &model);
  Hide(95, 97, All, &model);
  SurfaceModel spooled = model;
  spooled.history = HistoryOf(FramesOf(model.history), 0);
  RefineHiddenMotions(poses, {}, &model);
  RefineHiddenMotions(poses, {}, &spooled);
  EXPECT_EQ(FarthestNode(model, spooled), 0);
}

TEST(HiddenMotions, DoNotDependOnThreads) {
  const auto poses = Poses(FramesUpTo(30));
  SurfaceModel first = SeenPlate(poses, Walk);
  Hide(10, 24, All, &first);
  const SurfaceModel joined = JoinModels({first, first, first});
  std::array<SurfaceModel, 2> models = {joined, joined};
  for (const std::size_t threads : {1, 4}) {
    const tbb::global_control limit(
        tbb::global_control::max_allowed_parallelism, threads);
    RefineHiddenMotions(poses, {}, &models[threads / 4]);
  }
  EXPECT_EQ(FarthestNode(models[0], models[1]), 0);
}

TEST(HiddenMotions, OptionsAreChecked) {
  HiddenMotionOptions options;
  options.window = 3;
  ExpectInputError([&] { CheckOptions(options); }, "refine_window");
  options = {};
  options.smoothness = 0;
  ExpectInputError([&] { CheckOptions(options); }, "refine_smoothness");
  options = {};
  options.samples = -1;
  ExpectInputError([&] { CheckOptions(options); }, "refine_samples");
}

}  // namespace
}  // namespace splitfusion
