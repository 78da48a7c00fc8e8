#include "split_models.h"

#include <utility>

#include "labelled_view.h"
#include "people_scene.h"
#include "splitfusion/lib/association/association.h"
#include "splitfusion/pipelines/surface_tracker.h"

namespace splitfusion {
namespace {

constexpr int kPeople = 2;
constexpr int kStride = 4;  // Of the points, as in the non-rigid stages.

Eigen::Vector3f ToEigen(const cv::Vec3f& v) { return {v[0], v[1], v[2]}; }

/// A pixel as a sample of a model that one node carries.
ModelSample SampleAt(const LiveView& live, int u, int v) {
  ModelSample sample;
  sample.point = ToEigen(live.map.points(v, u));
  sample.normal = ToEigen(live.map.normals(v, u));
  sample.intensity = {live.grey[0].value(v, u), live.grey[1].value(v, u)};
  sample.u = u;
  sample.v = v;
  sample.skinning.weights[0] = 1;
  sample.skinning.count = 1;
  return sample;
}

/// Every n-th pixel of one label that has a normal.
std::vector<ModelSample> SamplesOf(const LiveView& live, int label) {
  std::vector<ModelSample> samples;
  for (int v = 0; v < live.depth.rows; v += kStride) {
    for (int u = 0; u < live.depth.cols; u += kStride) {
      if (live.labels(v, u) != label || !(live.depth(v, u) > 0)) continue;
      const ModelSample sample = SampleAt(live, u, v);
      if (sample.normal.norm() > 0.5f) samples.push_back(sample);
    }
  }
  return samples;
}

/// The surface of the pixels labelled `id`.
PairedSurface MakePaired(const LiveView& live, int id, SurfaceKind kind,
                         const SurfaceOptions& options,
                         const GraphOptions& graph,
                         std::vector<Correspondence> pairs) {
  auto surface = std::make_unique<Surface>(id, "", kind, 0, options, graph);
  surface->Initialize(live);
  for (Correspondence& pair : pairs) {
    pair.model.skinning = surface->skinning_index().Skin(pair.model.point);
  }
  return {std::move(surface), std::move(pairs)};
}

/// A view in which all is one surface.
LiveView WithoutLabels(LiveView live) {
  live.labels = cv::Mat_<std::uint16_t>::zeros(live.labels.size());
  return live;
}

}  // namespace

FramePair::FramePair(int height) {
  const PeopleScene scene(kPeople, height);
  before = LabelledView(scene, 0);
  after = LabelledView(scene, 1);
  const WarpField still(MakeRigidGraph(Rigid3d::Identity()));
  const AssociationGates gates = TrackerOptions().NonRigidStages()[0].gates;
  for (int label = 0; label <= kPeople; ++label) {
    const Association association =
        MakeProjectiveAssociator(after, label)
            ->Associate(SamplesOf(before, label), still, kStride, gates);
    pairs.push_back(association.correspondences);
  }
}

SceneModel MakeSplitModel(const FramePair& frames,
                          const SurfaceOptions& background,
                          const SurfaceOptions& object,
                          const GraphOptions& graph) {
  SceneModel model;
  model.surfaces.push_back(MakePaired(frames.before, 0, SurfaceKind::kRigid,
                                      background, graph, frames.pairs[0]));
  for (int label = 1; label <= kPeople; ++label) {
    model.surfaces.push_back(MakePaired(frames.before, label,
                                        SurfaceKind::kNonRigid, object, graph,
                                        frames.pairs[label]));
  }
  model.after = frames.after;
  return model;
}

SceneModel MakeOneGraphModel(const FramePair& frames,
                             const SurfaceOptions& options,
                             const GraphOptions& graph) {
  std::vector<Correspondence> all;
  for (const auto& pairs : frames.pairs) {
    all.insert(all.end(), pairs.begin(), pairs.end());
  }
  SceneModel model;
  model.surfaces.push_back(MakePaired(WithoutLabels(frames.before), 0,
                                      SurfaceKind::kNonRigid, options, graph,
                                      std::move(all)));
  model.after = WithoutLabels(frames.after);
  return model;
}

}  // namespace splitfusion
