// CheckGradients() finds what is wrong with a term, and nothing else.

#include <gtest/gtest.h>

#include <cmath>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/gradient_check.h"
#include "splitfusion/lib/energy/links_in_time.h"
#include "splitfusion/lib/energy/surface_history.h"
#include "support/sample_correspondences.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

double Value(double x) { return x; }
template <typename T, int N>
double Value(const ceres::Jet<T, N>& x) {
  return x.a;
}

/// A functor that forgets to differentiate one coordinate, as code does that
/// takes a value out of a Jet; or whose value is none.
template <int kWrong>
class WrongTerm : public EnergyTerm {
 public:
  struct Functor {
    static constexpr int kResiduals = 1;
    template <typename T>
    bool operator()(const T* x, T* residual) const {
      residual[0] =
          kWrong == 1 ? x[0] + T(Value(x[2])) : T(std::nan("")) * x[0];
      return true;
    }
  };

  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    std::vector<const ModelSample*> samples;
    for (const Correspondence& c : input.correspondences) {
      samples.push_back(&c.model);
    }
    sink->AddWarpedPoints(samples, std::vector<Functor>(samples.size()));
  }
};

class GradientReport : public ::testing::Test {
 protected:
  GradientReport() {
    terms_.Register("forgetful",
                    [] { return std::make_unique<WrongTerm<1>>(); });
    terms_.Register("undefined",
                    [] { return std::make_unique<WrongTerm<2>>(); });
    Shake(0.01, /*seed=*/3, &graph_);
    correspondences_ = PerfectAssociation(
        mesh_, graph_,
        [](const Eigen::Vector3d& p) { return Bend(p, 1, 2.0); });
    const Eigen::Matrix3f turn =
        ExpSo3(Eigen::Vector3d(0.1, -0.2, 0)).cast<float>();
    for (Correspondence& c : correspondences_) {
      c.intensity_difference = 0.05f;
      c.intensity_gradient = {0.02f, -0.01f};
      c.target_normal = turn * c.warped_normal;
    }
    tracks_.resize(5);
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      tracks_[i].model = correspondences_[7 * i].model;
      tracks_[i].target = correspondences_[7 * i + 2].target;
    }
    lost_.assign(correspondences_.begin(), correspondences_.begin() + 9);
    before_.assign(graph_.size(), NodeMotion());
    links_.known_positions = {{0, 0, 1}, {0.1, 0, 1.1}};
    links_.known_motions.resize(2);
    links_.edges = {{0, 1}, {0, graph_.size()}, {graph_.size() + 1, 2}};
    links_.triples = {{0, 1, 2}, {graph_.size(), 3, graph_.size() + 1}};
    links_.differences = {{1, -2, 1}, {0.5, -1.5, 1}};
    for (const int frame : {0, 1}) motions_.Append({frame, true, before_});
    const DepthObservation wall =
        ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1));
    AllocateBand(wall, Rigid3d::Identity(), &volume_);
    IntegrateRigid(wall, Rigid3d::Identity(), &volume_);
  }

  std::vector<GradientError> Check(const std::string& energy) const {
    const Energy parsed = ParseEnergy(energy, terms_);
    SurfaceProblem problem{parsed, correspondences_, camera_};
    problem.before = &before_;
    problem.anneal = 2;
    problem.lost = &lost_;
    problem.tracks = &tracks_;
    problem.links = &links_;
    const SurfaceHistory history({graph_, motions_});
    const FrameFacts frame{/*index=*/2};
    problem.context.frame = &frame;
    problem.context.history = &history;
    SurfaceFacts surface;
    surface.volume = &volume_;
    problem.context.surface = &surface;
    problem.context.round.rigid = false;
    return CheckGradients(problem, graph_);
  }

  TermRegistry terms_ = BuiltinTerms();
  const TriangleMesh mesh_ = PlateMesh(0.2, 0.1, 0.02, 1);
  const PinholeCamera camera_{640, 480, 525, 525, 319.5, 239.5};
  DeformationGraph graph_ = CoverWithNodes(mesh_, 0.04);
  std::vector<Correspondence> correspondences_, lost_;
  std::vector<TrackedPoint> tracks_;
  std::vector<NodeMotion> before_;
  LinksInTime links_;
  MotionLog motions_;
  TsdfVolume volume_{TsdfOptions{/*voxel_size=*/0.02, /*truncation=*/0.2}};
};

TEST_F(GradientReport, TermsOfTheToolkitAreRight) {
  std::string energy;
  for (const std::string& name : BuiltinTerms().names()) {
    energy += name + "(loss=tukey,scale=0.1) ";
  }
  for (const GradientError& error : Check(energy)) {
    EXPECT_GT(error.residuals, 0) << error.term;
    EXPECT_LT(error.relative, 1e-6) << error.term;
    EXPECT_EQ(error.failed, 0) << error.term;
  }
}

TEST_F(GradientReport, AForgottenDerivativeShows) {
  const std::vector<GradientError> errors = Check("arap forgetful undefined");
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_LT(errors[0].relative, 1e-6);
  EXPECT_EQ(errors[1].term, "forgetful");
  EXPECT_GT(errors[1].relative, 0.1);
  EXPECT_EQ(errors[1].failed, 0);
  EXPECT_GT(errors[2].failed, 0);
}

}  // namespace
}  // namespace splitfusion
