#include "support/two_cameras.h"

#include <random>
#include <vector>

namespace splitfusion {
namespace {

constexpr double kWallDepth = 2.5;

/// A rectangle of the plane z = depth of the depth camera's frame.
struct Board {
  double depth, left, right, top, bottom;  // Metres.
  int grey;
};

std::vector<Board> Boards(int index) {
  std::mt19937 random(100 + index);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Board> boards;
  for (int i = 0; i < 8; ++i) {
    const double depth = 0.8 + 1.1 * uniform(random);
    const double x = (uniform(random) - 0.5) * depth;
    const double y = (uniform(random) - 0.5) * 0.75 * depth;
    const double width = 0.05 + 0.1 * uniform(random);
    const double height = 0.05 + 0.1 * uniform(random);
    boards.push_back({depth, x - width, x + width, y - height, y + height,
                      static_cast<int>(40 + 60 * uniform(random))});
  }
  return boards;
}

struct Hit {
  double z = 0;  // Of the depth camera's frame, metres.
  int grey = 200;
};

/// The nearest board that a ray of the depth camera's frame meets, or the wall.
Hit Cast(const std::vector<Board>& boards, const Eigen::Vector3d& origin,
         const Eigen::Vector3d& ray) {
  Hit hit{kWallDepth};
  for (const Board& board : boards) {
    const Eigen::Vector3d p =
        origin + (board.depth - origin.z()) / ray.z() * ray;
    if (board.depth < hit.z && p.x() > board.left && p.x() < board.right &&
        p.y() > board.top && p.y() < board.bottom) {
      hit = {board.depth, board.grey};
    }
  }
  return hit;
}

}  // namespace

PinholeCamera BoardsCamera() {
  PinholeCamera camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 290;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

ColorCamera BoardsColorCamera() {
  ColorCamera color = ColorCamera::Registered(BoardsCamera());
  color.fx = color.fy = 0.9 * 290;
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 0.5).normalized();
  color.color_from_depth.linear() =
      Eigen::AngleAxisd(M_PI / 180, axis).toRotationMatrix();
  color.color_from_depth.translation() = Eigen::Vector3d(-0.025, 0, 0);
  return color;
}

Frame BoardsFrame(int index, const PinholeCamera& depth_camera,
                  const ColorCamera& color_camera) {
  const std::vector<Board> boards = Boards(index);
  const Rigid3d depth_from_color = color_camera.color_from_depth.inverse();
  Frame frame;
  frame.index = index;
  frame.depth.create(depth_camera.height, depth_camera.width, CV_32FC1);
  for (int v = 0; v < depth_camera.height; ++v) {
    for (int u = 0; u < depth_camera.width; ++u) {
      const Eigen::Vector3d ray = depth_camera.BackProject<double>(u, v, 1);
      frame.depth.at<float>(v, u) =
          static_cast<float>(Cast(boards, Eigen::Vector3d::Zero(), ray).z);
    }
  }
  frame.color.create(color_camera.SizeBeside(frame.depth.size()), CV_8UC3);
  for (int v = 0; v < frame.color.rows; ++v) {
    for (int u = 0; u < frame.color.cols; ++u) {
      const Eigen::Vector3d ray((u - color_camera.cx) / color_camera.fx,
                                (v - color_camera.cy) / color_camera.fy, 1);
      const int grey = Cast(boards, depth_from_color.translation(),
                            depth_from_color.linear() * ray)
                           .grey;
      frame.color.at<cv::Vec3b>(v, u) =
          cv::Vec3b::all(static_cast<uchar>(grey));
    }
  }
  return frame;
}

}  // namespace splitfusion
