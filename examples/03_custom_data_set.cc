// A data set of one's own: a class derived from SequenceReader gives the
// frames, the method takes them as any others.
//
// Here the frames are computed: the corner of a chequered room, seen by a
// camera that sways. A real reader opens its files instead and throws
// InputError, with the file's name, if one is missing or broken.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "splitfusion/lib/sequence/sequence_reader.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace {

/// A plane n . x = d of the world, metres.
struct Plane {
  Eigen::Vector3d normal;
  double offset;
};

/// The corner of a room, rendered on the fly.
class RoomCorner : public splitfusion::SequenceReader {
 public:
  RoomCorner() {
    camera_.width = 320;
    camera_.height = 240;
    camera_.fx = camera_.fy = 260;
    camera_.cx = 159.5;
    camera_.cy = 119.5;
  }

  const splitfusion::PinholeCamera& camera() const override { return camera_; }
  int size() const override { return 15; }

  std::optional<splitfusion::Frame> Next() override {
    if (next_ == size()) return std::nullopt;
    splitfusion::Frame frame;
    frame.index = next_;
    frame.timestamp = next_ / 30.0;
    frame.stem = std::to_string(next_);
    Render(WorldFromCamera(next_), &frame);
    ++next_;
    return frame;
  }

  /// Where the camera is; the world is the first camera.
  static splitfusion::Rigid3d WorldFromCamera(int frame) {
    const double t = 0.1 * frame;
    splitfusion::Rigid3d pose = splitfusion::Rigid3d::Identity();
    pose.linear() = splitfusion::ExpSo3({0.02 * t, 0.06 * std::sin(t), 0});
    pose.translation() << 0.10 * std::sin(t), 0.03 * t, 0.06 * t;
    return pose;
  }

 private:
  void Render(const splitfusion::Rigid3d& world_from_camera,
              splitfusion::Frame* frame) const {
    const Plane planes[] = {{Eigen::Vector3d(0.3, 0, 1).normalized(), 1.8},
                            {Eigen::Vector3d(-1, 0, 0.6).normalized(), 1.3},
                            {Eigen::Vector3d(0, 1, 0.5).normalized(), 1.2}};
    frame->color.create(camera_.height, camera_.width, CV_8UC3);
    frame->depth.create(camera_.height, camera_.width, CV_32FC1);
    const Eigen::Vector3d eye = world_from_camera.translation();
    for (int v = 0; v < camera_.height; ++v) {
      for (int u = 0; u < camera_.width; ++u) {
        const Eigen::Vector3d ray =
            world_from_camera.linear() * camera_.BackProject<double>(u, v, 1);
        double z = 5;
        for (const Plane& plane : planes) {
          const double along =
              (plane.offset - plane.normal.dot(eye)) / plane.normal.dot(ray);
          if (along > 0 && along < z) z = along;
        }
        frame->depth.at<float>(v, u) = static_cast<float>(z);
        frame->color.at<cv::Vec3b>(v, u) = Chequered(eye + z * ray);
      }
    }
  }

  /// Colour of a point of the room: soft squares of 25 cm.
  static cv::Vec3b Chequered(const Eigen::Vector3d& p) {
    double pattern = 1;
    for (int d = 0; d < 3; ++d) pattern *= std::sin(4 * M_PI * p[d] + 0.5);
    const auto grey = static_cast<std::uint8_t>(128 + 90 * pattern);
    return {grey, grey, static_cast<std::uint8_t>(255 - grey)};
  }

  splitfusion::PinholeCamera camera_;
  int next_ = 0;
};

}  // namespace

int main() {
  RoomCorner reader;
  // Without a segmenter the scene is one rigid surface.
  splitfusion::SplitFusion fusion(reader.camera(),
                                  splitfusion::PipelineOptions(),
                                  splitfusion::LabelTable(), nullptr);
  double error = 0;
  while (const auto frame = reader.Next()) {
    const splitfusion::FrameReport report = fusion.ProcessFrame(*frame);
    const splitfusion::Rigid3d found =
        fusion.trajectory().back().world_from_camera;
    const splitfusion::Rigid3d truth =
        RoomCorner::WorldFromCamera(frame->index);
    error = (found.translation() - truth.translation()).norm();
    std::printf("frame %2d  %-7s  %.2f s, position off by %.2f mm\n",
                report.frame, report.surfaces.at(0).state.c_str(),
                report.total_seconds, 1000 * error);
  }
  fusion.Finish();
  std::printf("mesh of the room: %zu vertices\n",
              fusion.surfaces().at(0)->mesh().vertices.size());
  return error < 0.005 ? 0 : 1;
}
