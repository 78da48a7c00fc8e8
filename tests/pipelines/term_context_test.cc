// What energy terms see of frame, surface, model and history in a run, what
// they keep of a surface, and energies of classes.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <mutex>
#include <set>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/surface_history.h"
#include "support/expect_input_error.h"
#include "support/synthetic_run.h"

namespace splitfusion {
namespace {

/// What a term has seen, of all surfaces.
struct Notes {
  std::mutex mutex;
  std::set<std::string> classes;
  std::set<int> frames;
  int rounds = 0;
  int with_history = 0;
};

void ExpectSameMotions(const std::vector<NodeMotion>& a,
                       const std::vector<NodeMotion>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_TRUE(a[i].rotation.isApprox(b[i].rotation, 1e-6));
    EXPECT_LT((a[i].translation - b[i].translation).norm(), 1e-6);
  }
}

/// Adds nothing; checks and notes what it sees.
class WitnessTerm : public EnergyTerm {
 public:
  explicit WitnessTerm(std::shared_ptr<Notes> notes)
      : notes_(std::move(notes)) {}

  void AddResiduals(const EnergyInput& input, ResidualSink*) const override {
    ExpectFrame(input);
    ExpectSurface(input);
    ExpectRound(input);
    const std::lock_guard<std::mutex> lock(notes_->mutex);
    notes_->classes.insert(input.context.surface->class_name);
    notes_->frames.insert(input.context.frame->index);
    ++notes_->rounds;
    const SurfaceHistory* history = input.context.history;
    if (history == nullptr) return;
    ExpectSameMotions(history->Before(1), *input.before);
    ++notes_->with_history;
  }

 private:
  static void ExpectFrame(const EnergyInput& input) {
    ASSERT_NE(input.context.frame, nullptr);
    const FrameFacts& frame = *input.context.frame;
    ASSERT_NE(frame.cameras, nullptr);
    EXPECT_EQ(static_cast<int>(frame.cameras->size()), frame.index);
    EXPECT_LT(frame.cameras->back().timestamp, frame.timestamp);
    ASSERT_NE(frame.detections, nullptr);
    EXPECT_FALSE(frame.detections->empty());
  }

  static void ExpectSurface(const EnergyInput& input) {
    ASSERT_NE(input.context.surface, nullptr);
    const SurfaceFacts& surface = *input.context.surface;
    EXPECT_EQ(surface.class_name == "background", input.surface == 0);
    EXPECT_EQ(surface.kind == SurfaceKind::kRigid, input.surface == 0);
    EXPECT_EQ(surface.mesh->vertices.size(), surface.skinning->size());
    ASSERT_NE(input.context.rendered, nullptr);
    const RenderedModel& rendered = *input.context.rendered;
    ASSERT_NE(rendered.normals, nullptr);
    EXPECT_EQ(rendered.normals->cols, rendered.camera.width);
    EXPECT_EQ(rendered.color != nullptr, input.surface == 0);
    EXPECT_EQ(rendered.depth != nullptr, input.surface != 0);
    ASSERT_NE(input.context.samples, nullptr);
    EXPECT_GE(input.context.samples->size(), input.correspondences.size());
  }

  static void ExpectRound(const EnergyInput& input) {
    const RoundFacts& round = input.context.round;
    EXPECT_EQ(round.rigid, input.graph.rigid());
    EXPECT_GE(round.round, 0);
    EXPECT_LT(round.round, round.rounds);
    EXPECT_GT(round.stride, 0);
    ASSERT_NE(input.options, nullptr);
    EXPECT_EQ(input.options->name, "witness");
    EXPECT_EQ(input.options->weight, 3);
    EXPECT_EQ(input.state, nullptr);
  }

  std::shared_ptr<Notes> notes_;
};

TEST(TermContext, ATermSeesFrameSurfaceModelRoundAndHistory) {
  const auto notes = std::make_shared<Notes>();
  Registries registries;
  registries.terms.Register(
      "witness", [=] { return std::make_unique<WitnessTerm>(notes); });
  PipelineOptions options;
  options.terms += " witness(weight=3)";
  SyntheticRun run(SyntheticRun::Quick(), options, registries);
  for (int i = 0; i < 4; ++i) run.Next();
  EXPECT_EQ(notes->classes,
            (std::set<std::string>{"background", "person", "teddy bear"}));
  EXPECT_EQ(notes->frames, (std::set<int>{1, 2, 3}));
  EXPECT_GT(notes->with_history, notes->rounds / 2);
}

TEST(TermContext, AClassHasAnEnergyOfItsOwn) {
  PipelineOptions options;
  options.terms += " person.velocity(weight=2) background.tracks(weight=0)";
  SyntheticRun run(SyntheticRun::Quick(), options);
  run.Next();
  const FrameReport report = run.Next();
  for (const SurfaceReport& surface : report.surfaces) {
    ASSERT_FALSE(surface.rounds.empty());
    std::set<std::string> terms;
    for (const TermCost& term : surface.rounds.back().solver.terms) {
      terms.insert(term.term);
    }
    EXPECT_EQ(terms.count("velocity") > 0, surface.label == "person");
    EXPECT_EQ(terms.count("tracks"), 1u) << "of no weight, but there";
  }
  EXPECT_EQ(run.fusion().energies().classes(),
            (std::vector<std::string>{"background", "person"}));
}

/// Frames since the surface was born.
struct Age : TermState {
  std::string Save() const override { return std::to_string(frames); }
  void Load(const std::string& bytes) override { frames = std::stoi(bytes); }
  int frames = 0;
};

/// Pulls nodes up, the stronger the older the surface is.
class AgeTerm : public EnergyTerm {
 public:
  struct Pull {
    static constexpr int kResiduals = 1;
    double way;
    template <typename T>
    bool operator()(T const* const* twists, T* residual) const {
      residual[0] = T(way) - twists[0][4];
      return true;
    }
  };

  std::unique_ptr<TermState> NewState() const override {
    return std::make_unique<Age>();
  }
  void Prepare(const EnergyInput& input, TermState* state) const override {
    EXPECT_TRUE(input.correspondences.empty());
    EXPECT_NE(input.live, nullptr);
    ++static_cast<Age*>(state)->frames;
  }
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    ASSERT_NE(input.state, nullptr);
    const int frames = static_cast<const Age&>(*input.state).frames;
    sink->AddNodes({{0}}, std::vector<Pull>{{1e-3 * frames}});
  }
};

TEST(TermContext, WhatATermKeepsSurvivesACheckpoint) {
  Registries registries;
  registries.terms.Register("age", [] { return std::make_unique<AgeTerm>(); });
  PipelineOptions options;
  options.terms += " age(weight=1)";
  SyntheticRun whole(SyntheticRun::Quick(), options, registries);
  SyntheticRun resumed(SyntheticRun::Quick(), options, registries);
  SyntheticRun without(SyntheticRun::Quick());
  for (int i = 0; i < 5; ++i) {
    whole.Next();
    without.Next();
    resumed.Next();
    resumed.RestartFrom(resumed.State());
    ASSERT_TRUE(resumed.State() == whole.State()) << "frame " << i;
  }
  EXPECT_TRUE(SameResults(whole.fusion(), resumed.fusion()));
  EXPECT_FALSE(SameResults(whole.fusion(), without.fusion()));
}

/// Takes three numbers each a step farther from where it began the frame.
class WalkTerm : public EnergyTerm {
 public:
  struct Step {
    static constexpr int kResiduals = 3;
    static constexpr int kUnknowns = 3;
    std::array<double, 3> aims;
    template <typename T>
    bool operator()(const T* unknowns, T* residual) const {
      for (int u = 0; u < 3; ++u) residual[u] = unknowns[u] - T(aims[u]);
      return true;
    }
  };

  std::vector<Unknown> Unknowns() const override {
    return {{"new", "", 1, 1, UnknownStart::kInitial},
            {"kept", "", 1, 1, UnknownStart::kFrameBefore},
            {"shared", "", 1, 1, UnknownStart::kBackground}};
  }
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    ASSERT_NE(input.begun, nullptr);
    const std::vector<double>& begun = *input.begun;
    ASSERT_EQ(begun.size(), 3u);
    sink->AddUnknowns(
        std::vector<Step>{{{begun[0] + 1, begun[1] + 1, begun[2] + 1}}});
  }
};

TEST(TermContext, UnknownsBeginWhereTheySay) {
  Registries registries;
  registries.terms.Register("walk",
                            [] { return std::make_unique<WalkTerm>(); });
  PipelineOptions options;
  options.terms += " walk(weight=1e-2)";
  SyntheticRun run(SyntheticRun::Quick(), options, registries);
  run.Next();
  for (int frame = 1; frame < 4; ++frame) {
    SCOPED_TRACE(frame);
    const FrameReport report = run.Next();
    ASSERT_GE(report.surfaces.size(), 2u);
    EXPECT_EQ(report.surfaces[1].label, "person");
    for (const SurfaceReport& surface : report.surfaces) {
      SCOPED_TRACE(surface.label);
      if (surface.label == "teddy bear") continue;  // Too small to be tracked.
      ASSERT_FALSE(surface.rounds.empty());
      const auto& first = surface.rounds.front().solver.unknowns;
      const auto& last = surface.rounds.back().solver.unknowns;
      ASSERT_EQ(first.size(), 3u);
      EXPECT_EQ(first[0].initial, 1);
      EXPECT_NEAR(first[1].initial, frame, 0.01);
      EXPECT_NEAR(first[2].initial, surface.id == 0 ? frame : frame + 1, 0.01);
      EXPECT_NEAR(last[1].final, frame + 1, 0.01);
    }
    run.RestartFrom(run.State());
  }
}

/// A residual of one node that there may not be, or of a value that is none.
class WrongTerm : public EnergyTerm {
 public:
  void List(OptionList* list) override {
    list->Number("node", &node_, Range(), "", "Whose residual it is.");
  }
  void AddResiduals(const EnergyInput&, ResidualSink* sink) const override {
    sink->AddNodes({{node_}}, std::vector<AgeTerm::Pull>{{std::nan("")}});
  }

 private:
  int node_ = 0;
};

TEST(TermContext, WhatATermGetsWrongDoesNotCrash) {
  Registries registries;
  registries.terms.Register("wrong",
                            [] { return std::make_unique<WrongTerm>(); });
  const auto second_frame = [&](const std::string& node) {
    PipelineOptions options;
    options.terms += " wrong(node=" + node + ")";
    SyntheticRun run(SyntheticRun::Quick(), options, registries);
    run.Next();
    return run.Next();
  };
  for (const std::string node : {"-1", "100000"}) {
    ExpectInputError(
        [&] { second_frame(node); },
        "nodes of a residual = " + node + ": expected nodes of a graph of ");
  }
  for (const SurfaceReport& surface : second_frame("0").surfaces) {
    if (!surface.event.empty()) continue;
    EXPECT_NE(surface.state, TrackState::kTracked) << surface.label;
  }
}

}  // namespace
}  // namespace splitfusion
