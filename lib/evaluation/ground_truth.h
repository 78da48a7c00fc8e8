#ifndef SPLITFUSION_LIB_EVALUATION_GROUND_TRUTH_H_
#define SPLITFUSION_LIB_EVALUATION_GROUND_TRUTH_H_

#include <map>
#include <set>
#include <string>
#include <vector>

#include "splitfusion/lib/sequence/trajectory.h"

namespace splitfusion {

/// Largest difference of a frame of a run from a true mesh or pose, seconds.
inline constexpr double kMaxTimeDifference = 0.02;

/// A true mesh of one moving instance at one time.
struct PosedMeshFile {
  int instance = 0;      ///< Instance id, from 1.
  double timestamp = 0;  ///< Seconds.
  std::string path;      ///< PLY, world frame.
};

/// An instance of the label images.
struct TrueInstance {
  std::string name;     ///< Of labels.json.
  bool moving = false;  ///< As labels.json says; false if it does not.
  bool rigid = false;   ///< The same.
};

/// What is known about a sequence. Paths are empty where there is nothing.
struct GroundTruth {
  std::string folder;       ///< Where groundtruth.txt lies.
  Trajectory trajectory;    ///< World from camera, in the order of the file.
  std::string static_mesh;  ///< static_mesh.ply
  std::string tracks;       ///< tracks.bin
  std::string labels;       ///< Folder label/ of STEM.png, instance per pixel.
  std::vector<PosedMeshFile> posed_meshes;  ///< mesh/instK_T.ply, by K and T.
  std::map<int, TrueInstance> instances;    ///< By id, of labels.json.

  /// Ids of the instances that move: labels.json says so, or there is a mesh.
  std::set<int> MovingInstances() const;
  /// An instance as labels.json has it, or else one without a name.
  TrueInstance Find(int instance) const;
};

/// Finds ground truth in the subfolder `gt` of `folder` if that has a
/// groundtruth.txt, or else in `folder` itself.
///
/// @throw InputError if neither has a groundtruth.txt, or if it or labels.json
///     is broken.
GroundTruth ReadGroundTruth(const std::string& folder);

/// Files that ground truth consists of, sorted paths relative to
/// GroundTruthRoot(), whatever they hold; nothing is read.
std::vector<std::string> GroundTruthFiles(const std::string& folder);

/// The folder of the two in which ReadGroundTruth() looks.
std::string GroundTruthRoot(const std::string& folder);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_GROUND_TRUTH_H_
