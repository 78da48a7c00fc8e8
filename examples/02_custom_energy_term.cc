// An energy term of one's own, in one file: landmarks.
//
// A sheet is rolled up a little and slides along itself. Point-to-plane
// distances do not see the sliding; a few points whose places are known, marked
// by hand or by a keypoint detector, do. The term is a plain template functor
// and a small class; derivatives, the warp over the graph's nodes, loss, weight
// and the account in the report come with the library.

#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/deformation/graph_growth.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/solver.h"

namespace {

/// Distance of a warped model point to the place where it is known to be.
///
///   r = x - y
///
/// x is the warped point (Eq. 2), y its place in the camera frame. Residual: 3,
/// metres. Zero if and only if the point is there.
struct LandmarkDistance {
  static constexpr int kResiduals = 3;
  Eigen::Vector3d place;  ///< y, camera frame, metres.

  /// `x`: warped point, camera frame, metres.
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    for (int d = 0; d < 3; ++d) residual[d] = x[d] - T(place[d]);
    return true;
  }
};

/// A model point that is known to be at a place.
struct Landmark {
  splitfusion::ModelSample model;  ///< Canonical, with its skinning.
  Eigen::Vector3d place;           ///< Camera frame, metres.
};

/// E = weight / N * sum over the landmarks.
class LandmarkTerm : public splitfusion::EnergyTerm {
 public:
  explicit LandmarkTerm(std::vector<Landmark> landmarks)
      : landmarks_(std::move(landmarks)) {}

  void AddResiduals(const splitfusion::EnergyInput&,
                    splitfusion::ResidualSink* sink) const override {
    std::vector<const splitfusion::ModelSample*> samples;
    std::vector<LandmarkDistance> functors;
    for (const Landmark& landmark : landmarks_) {
      samples.push_back(&landmark.model);
      functors.push_back({landmark.place});
    }
    sink->AddWarpedPoints(samples, functors);
  }

 private:
  std::vector<Landmark> landmarks_;
};

/// What becomes of the sheet: it is rolled up about an axis along y (radius 1
/// m) and slides by 3 cm along y.
Eigen::Vector3d TrueMotion(const Eigen::Vector3d& p) {
  return {std::sin(p.x()), p.y() + 0.03, 2 - std::cos(p.x())};
}

/// A sheet of 0.4 x 0.3 m at z = 1 m, vertices every centimetre.
splitfusion::TriangleMesh MakeSheet() {
  constexpr int kColumns = 41, kRows = 31;
  splitfusion::TriangleMesh mesh;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      mesh.vertices.emplace_back(0.01f * column - 0.2f, 0.01f * row - 0.15f, 1);
      if (row == 0 || column == 0) continue;
      const int i = row * kColumns + column;
      mesh.triangles.emplace_back(i, i - kColumns, i - 1);
      mesh.triangles.emplace_back(i - 1, i - kColumns, i - kColumns - 1);
    }
  }
  return mesh;
}

/// The sheet, its graph, and how its points are carried.
struct Model {
  Model() {
    graph.node_spacing = 0.04;
    splitfusion::GrowGraph(mesh, splitfusion::GraphOptions(), &graph, nullptr);
    const splitfusion::SkinningIndex index(graph, /*neighbors_per_point=*/6);
    for (const Eigen::Vector3f& v : mesh.vertices) {
      splitfusion::ModelSample sample;
      sample.point = v;
      sample.normal = {0, 0, -1};
      sample.skinning = index.Skin(v);
      samples.push_back(sample);
    }
  }
  splitfusion::TriangleMesh mesh = MakeSheet();
  splitfusion::DeformationGraph graph;
  std::vector<splitfusion::ModelSample> samples;
};

/// Every point with the live point in front of or behind it, as projective
/// association finds it.
std::vector<splitfusion::Correspondence> Associate(const Model& model) {
  const splitfusion::WarpField warp(model.graph);
  std::vector<splitfusion::Correspondence> correspondences;
  for (const splitfusion::ModelSample& sample : model.samples) {
    splitfusion::Correspondence c;
    c.model = sample;
    c.warped_normal = warp.WarpNormal(sample.skinning, sample.normal);
    c.target = warp.WarpPoint(sample.skinning, sample.point);
    c.target.z() = 2 - std::sqrt(1 - c.target.x() * c.target.x());
    c.target_normal = c.warped_normal;
    correspondences.push_back(c);
  }
  return correspondences;
}

/// Minimises the energy, with a new association before every step.
void Fit(const splitfusion::Energy& energy, Model* model) {
  splitfusion::PinholeCamera camera;  // Not looked at by these terms.
  for (int round = 0; round < 10; ++round) {
    const auto correspondences = Associate(*model);
    const splitfusion::SolverReport report =
        splitfusion::Minimize({energy, correspondences, camera},
                              splitfusion::SolverOptions(), &model->graph);
    if (round < 9) continue;
    for (const splitfusion::TermCost& term : report.terms) {
      std::printf("  %s: cost %.5f over %d\n", term.term.c_str(), term.final,
                  term.residual_vectors);
    }
  }
}

/// Mean distance of the sheet's points to where they should be, metres.
double MeanError(const Model& model) {
  const splitfusion::WarpField warp(model.graph);
  double sum = 0;
  for (const splitfusion::ModelSample& s : model.samples) {
    const Eigen::Vector3f x = warp.WarpPoint(s.skinning, s.point);
    sum += (x.cast<double>() - TrueMotion(s.point.cast<double>())).norm();
  }
  return sum / static_cast<double>(model.samples.size());
}

}  // namespace

int main() {
  const Model rest;
  std::vector<Landmark> landmarks;
  for (const std::size_t i : {0u, 40u, 635u, 1230u, 1270u}) {
    const splitfusion::ModelSample& sample = rest.samples[i];
    landmarks.push_back({sample, TrueMotion(sample.point.cast<double>())});
  }
  splitfusion::TermRegistry terms = splitfusion::BuiltinTerms();
  terms.Register("landmark",
                 [&] { return std::make_unique<LandmarkTerm>(landmarks); });

  double error = 0;
  for (const char* text :
       {"point_to_plane arap(weight=2)",
        "point_to_plane arap(weight=2) landmark(weight=5,loss=huber)"}) {
    Model model;
    std::printf("%s\n", text);
    Fit(splitfusion::ParseEnergy(text, terms), &model);
    error = MeanError(model);
    std::printf("  mean error %.1f mm\n", 1000 * error);
  }
  return error < 0.005 ? 0 : 1;
}
