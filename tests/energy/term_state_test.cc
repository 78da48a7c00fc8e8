#include "splitfusion/lib/energy/term_state.h"

#include <gtest/gtest.h>

#include <sstream>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/energy/term_residuals.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

/// Number of frames that a surface was prepared for.
struct Count : TermState {
  std::string Save() const override { return std::to_string(frames); }
  void Load(const std::string& bytes) override {
    if (bytes.empty()) throw InputError("count: expected a number");
    frames = std::stoi(bytes);
  }
  int frames = 0;
};

/// Pulls every node by its count, metres.
class CountTerm : public EnergyTerm {
 public:
  struct Pull {
    static constexpr int kResiduals = 1;
    double way;
    template <typename T>
    bool operator()(T const* const* twists, T* residual) const {
      residual[0] = T(way) + twists[0][3];
      return true;
    }
  };

  std::unique_ptr<TermState> NewState() const override {
    return std::make_unique<Count>();
  }
  void Prepare(const EnergyInput&, TermState* state) const override {
    ++static_cast<Count*>(state)->frames;
  }
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    if (input.state == nullptr) return;
    const auto& count = static_cast<const Count&>(*input.state);
    EXPECT_EQ(input.options->weight, 2);
    sink->AddNodes({{0}}, std::vector<Pull>{{1.0 * count.frames}});
  }
};

class TermStatesTest : public ::testing::Test {
 protected:
  TermStatesTest() {
    terms_.Register("count", [] { return std::make_unique<CountTerm>(); });
    energy_ = ParseEnergy("count(weight=2) count(weight=2)", terms_);
  }

  int FramesOf(const TermStates& states, std::size_t i) const {
    const TermState* state = states.Find(energy_, i);
    return state == nullptr ? -1 : static_cast<const Count*>(state)->frames;
  }

  static TermStates Restored(const std::string& bytes) {
    std::istringstream stream(bytes);
    TermStates states;
    ArchiveReader archive(&stream, bytes.size(), "state");
    archive(states);
    return states;
  }

  static std::string Saved(TermStates* states) {
    std::ostringstream stream;
    ArchiveWriter archive(&stream);
    archive(*states);
    archive.Flush();
    return stream.str();
  }

  TermRegistry terms_{"term"};
  Energy energy_;
  const DeformationGraph graph_ = PlateGraph();
  const std::vector<Correspondence> none_;
  const PinholeCamera camera_;
  const EnergyInput input_{graph_, none_, camera_};
};

TEST_F(TermStatesTest, EveryTermHasItsOwn) {
  TermStates states;
  EXPECT_EQ(FramesOf(states, 0), -1);
  states.Prepare(energy_, input_);
  states.Prepare({energy_[0]}, input_);
  EXPECT_EQ(FramesOf(states, 0), 2);
  EXPECT_EQ(FramesOf(states, 1), 1);
}

TEST_F(TermStatesTest, TermsGetTheirsWithTheProblem) {
  TermStates states;
  for (int i = 0; i < 3; ++i) states.Prepare(energy_, input_);
  SurfaceProblem problem{energy_, none_, camera_};
  EXPECT_EQ(CountResiduals(CollectResiduals(problem, graph_)), 0);
  problem.context.states = &states;
  EXPECT_EQ(CountResiduals(CollectResiduals(problem, graph_)), 2);
}

TEST_F(TermStatesTest, GoOnWhereTheyWereSaved) {
  TermStates states;
  states.Prepare(energy_, input_);
  states.Prepare(energy_, input_);
  const std::string saved = Saved(&states);
  TermStates restored = Restored(saved);
  EXPECT_EQ(Saved(&restored), saved) << "before anything is prepared";
  restored.Prepare(energy_, input_);
  EXPECT_EQ(FramesOf(restored, 0), 3);
  EXPECT_EQ(FramesOf(restored, 1), 3);
}

}  // namespace
}  // namespace splitfusion
