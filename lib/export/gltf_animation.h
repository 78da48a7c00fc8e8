#ifndef SPLITFUSION_LIB_EXPORT_GLTF_ANIMATION_H_
#define SPLITFUSION_LIB_EXPORT_GLTF_ANIMATION_H_

#include <string>
#include <vector>

#include "splitfusion/lib/export/export_scene.h"
#include "splitfusion/lib/export/glb_file.h"

namespace splitfusion {

/// Translation and rotation of a node of glTF.
struct GltfPose {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();         ///< Metres.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< Unit.

  /// Writes it into the object of a node.
  void SetNode(nlohmann::ordered_json* node) const;
};

/// How node i of a surface lies in a frame: its place, and how it is turned.
GltfPose PoseOfNode(const ExportSurface& surface, const ExportMoment& moment,
                    int i);

/// The one animation of a file, by its channels.
class GltfAnimation {
 public:
  /// Adds arrays to `file`, which must stay; the times are those of `scene`.
  GltfAnimation(const ExportScene& scene, GlbFile* file);

  /// Accessor of the times of some frames of the scene, seconds.
  int AddTimes(const std::vector<std::size_t>& places);

  /// Moves a node: its pose at the times of an accessor. Of the two quaternions
  /// that are a rotation each is the one nearer to the last.
  void Move(int node, int times, const std::vector<GltfPose>& poses);

  /// Scales a node by 0 in the frames in which a surface is not there, which
  /// hides it with all below, and by 1 in all others; stepwise.
  void ShowWithin(int node, const std::vector<ExportMoment>& moments);

  /// Weights of the morph targets of a node, `values` by time, then target.
  void Morph(int node, int times, const std::vector<float>& values);

  /// Puts the animation into the file, unless it is empty.
  void Finish();

 private:
  void AddChannel(int node, const std::string& path, int times, int output,
                  const std::string& interpolation = "LINEAR");

  const ExportScene& scene_;
  GlbFile& file_;
  nlohmann::ordered_json channels_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json samplers_ = nlohmann::ordered_json::array();
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_GLTF_ANIMATION_H_
