#include "splitfusion/lib/export/gltf_animation.h"

#include <utility>

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

void GltfPose::SetNode(Json* node) const {
  (*node)["translation"] = {translation.x(), translation.y(), translation.z()};
  (*node)["rotation"] = {rotation.x(), rotation.y(), rotation.z(),
                         rotation.w()};
}

GltfPose PoseOfNode(const ExportSurface& surface, const ExportMoment& moment,
                    int i) {
  const NodeMotion& motion = moment.motions[i];
  // Eq. 1 of the node itself.
  return {surface.graph.positions[i] + motion.translation,
          Eigen::Quaterniond(motion.rotation).normalized()};
}

GltfAnimation::GltfAnimation(const ExportScene& scene, GlbFile* file)
    : scene_(scene), file_(*file) {}

int GltfAnimation::AddTimes(const std::vector<std::size_t>& places) {
  std::vector<float> times;
  for (const std::size_t place : places) {
    times.push_back(static_cast<float>(scene_.TimeOf(place)));
  }
  GlbArrayKind kind;
  kind.bounds = true;
  return file_.Add(times, kind);
}

void GltfAnimation::Move(int node, int times,
                         const std::vector<GltfPose>& poses) {
  std::vector<float> places, turns;
  Eigen::Vector4d before = Eigen::Vector4d::Zero();
  for (const GltfPose& pose : poses) {
    Eigen::Vector4d turn = pose.rotation.coeffs();
    if (turn.dot(before) < 0) turn = -turn;
    before = turn;
    for (int k = 0; k < 3; ++k) {
      places.push_back(static_cast<float>(pose.translation[k]));
    }
    for (int k = 0; k < 4; ++k) turns.push_back(static_cast<float>(turn[k]));
  }
  AddChannel(node, "translation", times, file_.Add(places, {"VEC3"}));
  AddChannel(node, "rotation", times, file_.Add(turns, {"VEC4"}));
}

void GltfAnimation::ShowWithin(int node,
                               const std::vector<ExportMoment>& moments) {
  std::vector<char> there(scene_.frames.size(), 0);
  for (const ExportMoment& moment : moments) there[moment.place] = 1;
  std::vector<std::size_t> places;
  std::vector<float> scales;
  for (std::size_t place = 0; place < there.size(); ++place) {
    if (place > 0 && there[place] == there[place - 1]) continue;
    places.push_back(place);
    scales.insert(scales.end(), 3, there[place]);
  }
  if (places.size() == 1) return;  // Always there.
  AddChannel(node, "scale", AddTimes(places), file_.Add(scales, {"VEC3"}),
             "STEP");
}

void GltfAnimation::Morph(int node, int times,
                          const std::vector<float>& values) {
  AddChannel(node, "weights", times, file_.Add(values, {}));
}

void GltfAnimation::AddChannel(int node, const std::string& path, int times,
                               int output, const std::string& interpolation) {
  channels_.push_back({{"sampler", samplers_.size()},
                       {"target", {{"node", node}, {"path", path}}}});
  samplers_.push_back(
      {{"input", times}, {"interpolation", interpolation}, {"output", output}});
}

void GltfAnimation::Finish() {
  if (channels_.empty()) return;
  file_.Append("animations", {{"name", "run"},
                              {"channels", std::move(channels_)},
                              {"samplers", std::move(samplers_)}});
}

}  // namespace splitfusion
