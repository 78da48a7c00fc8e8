// A data set of one's own: a SequenceFormat says where its images are and what
// they mean; registered beside the built-in ones it is recognised and read like
// them, with all checks of its files.
//
//   03_custom_data_set [FOLDER]
//
// Here the data set is a few computed images: the corner of a chequered room,
// seen by a camera that sways, with depth in tenths of a millimetre.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <string>

#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace {

constexpr int kFrames = 15;
constexpr double kDepthScale = 10000;

splitfusion::PinholeCamera Camera() {
  return {320, 240, 260, 260, 159.5, 119.5};
}

/// room_3.jpg or room_3.depth.png.
std::string FileName(int frame, const std::string& ending) {
  return "room_" + std::to_string(frame) + ending;
}

/// The layout of the data set.
class RoomFormat : public splitfusion::SequenceFormat {
 public:
  std::string Files() const override { return "room_0.jpg, ..."; }

  bool Recognises(const std::string& folder) const override {
    return std::filesystem::exists(folder + "/room_0.jpg");
  }

  std::vector<splitfusion::AssociatedFiles> FindFrames(
      const std::string& folder) const override {
    std::vector<splitfusion::AssociatedFiles> frames;
    for (int i = 0;; ++i) {
      const std::string color = FileName(i, ".jpg");
      if (!std::filesystem::exists(folder + "/" + color)) break;
      frames.push_back(
          {{i / 30.0, color}, {i / 30.0, FileName(i, ".depth.png")}});
    }
    if (frames.empty())
      throw splitfusion::InputError(folder + ": no room_0.jpg");
    return frames;
  }

  std::optional<splitfusion::Calibration> FindCalibration(
      const std::string&) const override {
    return splitfusion::Calibration{Camera(), kDepthScale};
  }
};

/// Where the camera is; the world is the first camera.
splitfusion::Rigid3d WorldFromCamera(int frame) {
  const double t = 0.1 * frame;
  splitfusion::Rigid3d pose = splitfusion::Rigid3d::Identity();
  pose.linear() = splitfusion::ExpSo3({0.02 * t, 0.06 * std::sin(t), 0});
  pose.translation() << 0.10 * std::sin(t), 0.03 * t, 0.06 * t;
  return pose;
}

/// Colour of a point of the room: soft squares of 25 cm.
cv::Vec3b Chequered(const Eigen::Vector3d& p) {
  double pattern = 1;
  for (int d = 0; d < 3; ++d) pattern *= std::sin(4 * M_PI * p[d] + 0.5);
  const auto grey = static_cast<std::uint8_t>(128 + 90 * pattern);
  return {grey, grey, static_cast<std::uint8_t>(255 - grey)};
}

/// z-depth of the corner along a ray (camera z = 1), metres.
double Depth(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) {
  const std::pair<Eigen::Vector3d, double> planes[] = {
      {Eigen::Vector3d(0.3, 0, 1).normalized(), 1.8},
      {Eigen::Vector3d(-1, 0, 0.6).normalized(), 1.3},
      {Eigen::Vector3d(0, 1, 0.5).normalized(), 1.2}};
  double z = 5;
  for (const auto& [normal, offset] : planes) {
    const double along = (offset - normal.dot(eye)) / normal.dot(ray);
    if (along > 0 && along < z) z = along;
  }
  return z;
}

void WriteFrame(const std::string& folder, int frame) {
  const splitfusion::PinholeCamera camera = Camera();
  const splitfusion::Rigid3d pose = WorldFromCamera(frame);
  cv::Mat_<cv::Vec3b> color(camera.height, camera.width);
  cv::Mat_<std::uint16_t> depth(camera.height, camera.width);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray =
          pose.linear() * camera.BackProject<double>(u, v, 1);
      const double z = Depth(pose.translation(), ray);
      color(v, u) = Chequered(pose.translation() + z * ray);
      depth(v, u) = static_cast<std::uint16_t>(std::lround(kDepthScale * z));
    }
  }
  cv::imwrite(folder + "/" + FileName(frame, ".jpg"), color);
  cv::imwrite(folder + "/" + FileName(frame, ".depth.png"), depth);
}

/// Returns how far the last position is from the true one, metres.
double Reconstruct(const std::string& folder) {
  splitfusion::Registries registries;
  registries.formats.Register("room",
                              [] { return std::make_unique<RoomFormat>(); });
  splitfusion::ImageFolderReader reader(folder, {}, registries.formats);
  std::printf("%s: %d frames, format %s\n", folder.c_str(), reader.size(),
              reader.options().format.c_str());
  // Without a segmenter the scene is one rigid surface.
  splitfusion::SplitFusion fusion(
      reader.camera(), splitfusion::PipelineOptions(),
      splitfusion::LabelTable(), nullptr, registries);
  double error = 0;
  while (const auto frame = reader.Next()) {
    const splitfusion::FrameReport report = fusion.ProcessFrame(*frame);
    const splitfusion::Rigid3d found =
        fusion.trajectory().back().world_from_camera;
    const splitfusion::Rigid3d truth = WorldFromCamera(frame->index);
    error = (found.translation() - truth.translation()).norm();
    std::printf("frame %2d  %-7s  %.2f s, position off by %.2f mm\n",
                report.frame, ToString(report.surfaces.at(0).state).c_str(),
                report.total_seconds, 1000 * error);
  }
  fusion.Finish();
  std::printf("mesh of the room: %zu vertices\n",
              fusion.surfaces().at(0)->mesh().vertices.size());
  return error;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder =
      argc > 1 ? argv[1]
               : (std::filesystem::temp_directory_path() / "splitfusion_room")
                     .string();
  std::filesystem::create_directories(folder);
  for (int i = 0; i < kFrames; ++i) WriteFrame(folder, i);
  return Reconstruct(folder) < 0.005 ? 0 : 1;
}
