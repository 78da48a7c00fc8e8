// Points that were matched by their looks: ORB features of a surface in this
// frame and the one before. What is found once a frame is kept in a state, goes
// on from frame to frame, and into checkpoints. One file, nothing else:
//   sf_run ... --terms_library=build/liborb.so --set="terms.orb.weight=1"

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/surface_history.h"
#include "splitfusion/lib/energy/terms_library.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace {

using splitfusion::EnergyInput;
using splitfusion::ModelSample;
using splitfusion::TermState;

/// Features with depth of a surface in one frame.
struct Features {
  int frame = -1;
  std::vector<cv::Vec3f> points;  ///< Camera frame, metres.
  std::vector<float> confidence;
  cv::Mat descriptors;  ///< A row each.

  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(frame, points, confidence, descriptors);
  }
};

/// A canonical point of the model, and where it is seen in the live frame.
struct Match {
  ModelSample model;
  Eigen::Vector3f target;
  float confidence = 0;
};

struct OrbState : TermState {
  Features features;           ///< Of the frame that was prepared last.
  std::vector<Match> matches;  ///< Of its rounds; made anew in every frame.

  std::string Save() const override {
    std::ostringstream bytes;
    splitfusion::ArchiveWriter archive(&bytes);
    Features copy = features;  // One function serves both directions.
    archive(copy);
    archive.Flush();
    return bytes.str();
  }
  void Load(const std::string& bytes) override {
    std::istringstream stream(bytes);
    splitfusion::ArchiveReader archive(&stream, bytes.size(), "state of orb");
    archive(features);
  }
};

/// r = sqrt(c) (x - v), metres.
struct PointDistance {
  static constexpr int kResiduals = 3;
  Eigen::Vector3d target;
  double root;  ///< sqrt(c).

  template <typename T>
  bool operator()(const T* x, T* residual) const {
    for (int d = 0; d < 3; ++d) residual[d] = T(root) * (x[d] - T(target[d]));
    return true;
  }
};

/// The mesh of a surface where it was in an earlier frame.
class MeshThen {
 public:
  /// `motions`: of the graph of the surface, in that frame.
  MeshThen(const EnergyInput& input,
           const std::vector<splitfusion::NodeMotion>& motions)
      : surface_(*input.context.surface),
        camera_(input.camera),
        front_(camera_.height, camera_.width, -1) {
    splitfusion::DeformationGraph graph = input.graph;
    graph.motions = motions;
    const splitfusion::WarpField warp(graph);
    for (std::size_t i = 0; i < surface_.mesh->vertices.size(); ++i) {
      was_.push_back(
          warp.WarpPoint((*surface_.skinning)[i], surface_.mesh->vertices[i]));
      const auto pixel = camera_.PixelOf(was_[i]);
      if (!pixel) continue;
      int& front = front_(pixel->y(), pixel->x());
      if (front < 0 || was_[front].z() > was_[i].z()) {
        front = static_cast<int>(i);
      }
    }
  }

  /// The vertex nearest to a point that was seen then, which must be within
  /// 1.5 cm; -1 if none is.
  int Nearest(const Eigen::Vector3f& point) const {
    const auto pixel = camera_.PixelOf(point);
    if (!pixel) return -1;
    int best = -1;
    float nearest = 0.015f;
    const cv::Rect around = cv::Rect(pixel->x() - 3, pixel->y() - 3, 7, 7) &
                            cv::Rect({}, front_.size());
    for (const int i : cv::Mat_<int>(front_(around).clone())) {
      if (i < 0 || (was_[i] - point).norm() >= nearest) continue;
      nearest = (was_[i] - point).norm();
      best = i;
    }
    return best;
  }

  /// Vertex i in the model.
  ModelSample Sample(int i) const {
    ModelSample sample;
    sample.point = surface_.mesh->vertices[i];
    sample.skinning = (*surface_.skinning)[i];
    return sample;
  }
  /// Vertex i in that frame.
  const Eigen::Vector3f& was(int i) const { return was_[i]; }

 private:
  const splitfusion::SurfaceFacts& surface_;
  const splitfusion::PinholeCamera& camera_;
  std::vector<Eigen::Vector3f> was_;
  cv::Mat_<int> front_;  // Number of the vertex in front.
};

class OrbTerm : public splitfusion::EnergyTerm {
 public:
  void List(splitfusion::OptionList* list) override {
    list->Number("features", &features_, splitfusion::Range{10, 5000}, "",
                 "Of a surface and frame.");
    list->Number("reach", &reach_, splitfusion::Range::Above(0), "metres",
                 "Matches that moved farther are left out.");
    list->Number("bits", &bits_, splitfusion::Range{0, 256}, "bits",
                 "Largest distance of two descriptors.");
  }

  std::unique_ptr<TermState> NewState() const override {
    return std::make_unique<OrbState>();
  }

  /// Once a frame; rounds only read what is found here.
  void Prepare(const EnergyInput& input, TermState* kept) const override {
    auto& state = static_cast<OrbState&>(*kept);
    if (input.live == nullptr || input.context.frame == nullptr) return;
    const int frame = input.context.frame->index;
    if (state.features.frame == frame) {  // It is looked for elsewhere.
      state.matches.clear();
      return;
    }
    const Features before = std::move(state.features);
    state.features = Find(input);
    state.features.frame = frame;
    state.matches = Matched(input, before, state.features);
  }

  void AddResiduals(const EnergyInput& input,
                    splitfusion::ResidualSink* sink) const override {
    if (input.state == nullptr) return;
    const auto& matches = static_cast<const OrbState&>(*input.state).matches;
    // In rigid rounds one node carries the surface from where they start.
    const auto* own = input.context.surface_graph;
    const bool rigid = own != nullptr && input.context.round.rigid;
    std::vector<ModelSample> models;
    std::vector<PointDistance> distances;
    // A few matches are not to weigh as much as all correspondences would.
    double total = 0;
    for (const auto& c : input.correspondences) total += c.weight;
    for (const Match& match : matches) {
      models.push_back(match.model);
      if (rigid) {
        ModelSample& model = models.back();
        model.point =
            splitfusion::WarpField(*own).WarpPoint(model.skinning, model.point);
        model.skinning = {};
        model.skinning.count = 1;
        model.skinning.weights[0] = 1;
      }
      distances.push_back(
          {match.target.cast<double>(), std::sqrt(match.confidence)});
      total += match.confidence;
    }
    if (models.empty()) return;
    std::vector<const ModelSample*> points;
    for (const ModelSample& model : models) points.push_back(&model);
    sink->AddWarpedPoints(points, distances, total);
  }

 private:
  Features Find(const EnergyInput& input) const {
    const splitfusion::LiveView& live = *input.live;
    cv::Mat grey;
    cv::cvtColor(live.color, grey, cv::COLOR_BGR2GRAY);
    std::vector<cv::KeyPoint> keys;
    cv::Mat descriptors;
    cv::ORB::create(features_)->detectAndCompute(
        grey, live.labels == input.surface, keys, descriptors);
    Features found;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const cv::Point2f at = keys[i].pt;
      const int u = cvRound(at.x), v = cvRound(at.y);
      if (!splitfusion::IsCertain(live, input.surface, v, u)) continue;
      const Eigen::Vector3f point =
          input.camera.BackProject<float>(at.x, at.y, live.depth(v, u));
      found.points.push_back({point.x(), point.y(), point.z()});
      found.confidence.push_back(live.confidence(v, u));
      found.descriptors.push_back(descriptors.row(static_cast<int>(i)));
    }
    return found;
  }

  /// Features of the frame before, and their model points, with those of now.
  std::vector<Match> Matched(const EnergyInput& input, const Features& before,
                             const Features& now) const {
    std::vector<Match> matches;
    const auto& context = input.context;
    std::optional<splitfusion::FrameMotions> then;
    if (context.history != nullptr) then = context.history->Find(1);
    const bool has_mesh = context.surface != nullptr &&
                          context.surface->mesh != nullptr &&
                          !context.surface->mesh->vertices.empty();
    if (before.points.empty() || now.points.empty() || !has_mesh || !then ||
        !then->tracked || then->frame != before.frame) {
      return matches;
    }
    const MeshThen mesh(input, then->motions);
    std::vector<cv::DMatch> pairs;
    cv::BFMatcher(cv::NORM_HAMMING, /*crossCheck=*/true)
        .match(before.descriptors, now.descriptors, pairs);
    for (const cv::DMatch& pair : pairs) {
      const Eigen::Vector3f from(before.points[pair.queryIdx].val);
      const Eigen::Vector3f to(now.points[pair.trainIdx].val);
      const int vertex = mesh.Nearest(from);
      if (pair.distance > static_cast<float>(bits_) || vertex < 0 ||
          (to - from).norm() > static_cast<float>(reach_)) {
        continue;
      }
      // The vertex stays as far beside the feature as it was.
      matches.push_back({mesh.Sample(vertex), to + mesh.was(vertex) - from,
                         now.confidence[pair.trainIdx]});
    }
    return matches;
  }

  int features_ = 500;
  double reach_ = 0.10;
  int bits_ = 48;
};

void AddTerms(splitfusion::TermRegistry* terms) {
  terms->Register("orb", [] { return std::make_unique<OrbTerm>(); });
}

}  // namespace

SPLITFUSION_TERMS_LIBRARY(AddTerms)
