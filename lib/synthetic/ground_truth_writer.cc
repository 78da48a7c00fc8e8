#include "splitfusion/lib/synthetic/ground_truth_writer.h"

#include <cmath>
#include <filesystem>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

using Eigen::Vector3f;

/// Magic number and version of tracks.bin.
constexpr std::uint32_t kTracksMagic = 0x4b525431;
constexpr std::uint32_t kTracksVersion = 1;

/// A vertex counts as seen if the depth at its pixel is its own within this.
constexpr float kSeenTolerance = 0.02f;  // Metres.
constexpr float kMinSeenDepth = 0.5f;    // Range of the sensor, metres.
constexpr float kMaxSeenDepth = 4.5f;

template <typename T>
void WriteValues(const std::vector<T>& values, std::ostream* out) {
  out->write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(T)));
}

bool IsSeen(const Vector3f& point, const Vector3f& normal,
            const cv::Mat_<float>& depth, const PinholeCamera& camera) {
  if (point.z() < kMinSeenDepth || point.z() > kMaxSeenDepth ||
      normal.dot(point) >= 0) {
    return false;
  }
  const auto pixel = camera.PixelOf(point);
  return pixel &&
         std::abs(depth(pixel->y(), pixel->x()) - point.z()) < kSeenTolerance;
}

}  // namespace

GroundTruthWriter::GroundTruthWriter(const std::string& directory,
                                     const SyntheticScene& scene,
                                     const SyntheticWriterOptions& options)
    : directory_(directory),
      scene_(scene),
      options_(options),
      seen_(scene.static_mesh().vertices.size(), 0.0) {
  fs::create_directories(fs::path(directory_) / "label");
  fs::create_directories(fs::path(directory_) / "mesh");
}

void GroundTruthWriter::AddFrame(const SyntheticFrame& frame) {
  const std::string& stem = frame.frame.stem;
  const int index = frame.frame.index;
  trajectory_.push_back({frame.frame.timestamp, frame.world_from_camera});
  WriteImage(directory_ + "/label/" + stem + ".png", frame.labels);
  for (const SyntheticInstance& instance : scene_.instances()) {
    if (!instance.moving || index % options_.mesh_every != 0) continue;
    WritePly(directory_ + "/mesh/inst" + std::to_string(instance.id) + "_" +
                 stem + ".ply",
             scene_.PosedMesh(instance.id, index));
  }
  if (index % options_.seen_every == 0) CountSeenVertices(frame);
  for (const Vector3f& position : scene_.TrackPositions(index)) {
    track_positions_.insert(track_positions_.end(), position.data(),
                            position.data() + 3);
  }
  for (const bool visible : scene_.TrackVisibility(frame)) {
    track_visible_.push_back(visible ? 1 : 0);
  }
}

void GroundTruthWriter::CountSeenVertices(const SyntheticFrame& frame) {
  const Rigid3f camera_from_world =
      frame.world_from_camera.inverse().cast<float>();
  const TriangleMesh& mesh = scene_.static_mesh();
  const cv::Mat_<float> depth = frame.true_depth;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const bool seen = IsSeen(camera_from_world * mesh.vertices[i],
                             camera_from_world.linear() * mesh.normals[i],
                             depth, scene_.camera());
    seen_[i] += seen ? 1 : 0;
  }
}

void GroundTruthWriter::Finish() const {
  WriteTumTrajectory(directory_ + "/groundtruth.txt", trajectory_);
  WriteStaticMesh();
  WriteLabels();
  WriteTracks();
  WriteConfig();
}

void GroundTruthWriter::WriteStaticMesh() const {
  const TriangleMesh& mesh = scene_.static_mesh();
  if (mesh.empty()) return;
  std::vector<double> labels(mesh.vertices.size(), 0.0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      labels[mesh.triangles[i][k]] = scene_.static_triangle_instances()[i];
    }
  }
  WritePly(directory_ + "/static_mesh.ply", mesh,
           {{"label", labels}, {"seen", seen_}});
}

void GroundTruthWriter::WriteLabels() const {
  nlohmann::json instances = nlohmann::json::array();
  for (const SyntheticInstance& instance : scene_.instances()) {
    instances.push_back({{"id", instance.id},
                         {"name", instance.name},
                         {"category", instance.category},
                         {"rigid", instance.rigid},
                         {"moving", instance.moving}});
  }
  WriteJson<nlohmann::json>(directory_ + "/labels.json",
                            {{"format_version", kFormatVersion},
                             {"background", 0},
                             {"instances", instances}},
                            1);
}

void GroundTruthWriter::WriteTracks() const {
  const auto& points = scene_.track_points();
  WriteFileAtomically(directory_ + "/tracks.bin", [&](std::ostream& out) {
    WriteValues<std::uint32_t>({kTracksMagic, kTracksVersion,
                                static_cast<std::uint32_t>(trajectory_.size()),
                                static_cast<std::uint32_t>(points.size())},
                               &out);
    for (const ScenePoint& point : points) {
      WriteValues<std::int32_t>({point.instance, point.triangle}, &out);
      WriteValues<float>({point.b1, point.b2}, &out);
    }
    WriteValues(track_positions_, &out);
    WriteValues(track_visible_, &out);
  });
}

void GroundTruthWriter::WriteConfig() const {
  const SyntheticOptions& options = scene_.options();
  WriteJson<nlohmann::json>(directory_ + "/config.json",
                            {{"format_version", kFormatVersion},
                             {"scene", ToString(options.scene)},
                             {"frames", options.frames},
                             {"width", options.width},
                             {"height", options.height},
                             {"seed", options.seed},
                             {"noise", options.noise},
                             {"exact_masks", options.exact_masks},
                             {"frame_rate", options.frame_rate},
                             {"camera_motion", options.camera_motion},
                             {"subject_speed", options.subject_speed},
                             {"track_points", options.track_points}},
                            1);
}

}  // namespace splitfusion
