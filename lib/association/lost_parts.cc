#include "splitfusion/lib/association/lost_parts.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/geometry/nearest_point.h"

namespace splitfusion {
namespace {

/// Cells of `stride` pixels in which, or beside which, something was found.
cv::Mat_<uchar> CoveredCells(const std::vector<Correspondence>& found,
                             const PinholeCamera& camera, int stride) {
  cv::Mat_<uchar> covered(camera.height / stride + 1, camera.width / stride + 1,
                          uchar(0));
  for (const Correspondence& c : found) {
    const auto pixel = camera.PixelAt(c.pixel.cast<float>());
    if (pixel) covered(pixel->y() / stride, pixel->x() / stride) = 255;
  }
  cv::dilate(covered, covered, cv::Mat());
  return covered;
}

}  // namespace

OpenPoints FindOpenPoints(const LiveView& live, std::uint16_t surface,
                          const std::vector<Correspondence>& found, int stride,
                          const AssociationGates& gates) {
  const cv::Mat_<uchar> covered = CoveredCells(found, live.camera, stride);
  const auto min_cosine = static_cast<float>(std::cos(gates.grazing_angle));
  OpenPoints open;
  for (int v = 0; v < live.depth.rows; v += stride) {
    for (int u = 0; u < live.depth.cols; u += stride) {
      if (covered(v / stride, u / stride) != 0 ||
          !IsCertain(live, surface, v, u) || live.map.normals(v, u)[2] == 0) {
        continue;
      }
      const Eigen::Vector3f point = ToEigen(live.map.points(v, u));
      const Eigen::Vector3f normal = ToEigen(live.map.normals(v, u));
      if (-normal.dot(point) < min_cosine * point.norm()) continue;
      open.points.push_back(point);
      open.normals.push_back(normal);
      open.weights.push_back(live.camera.noise.Confidence(point.z()));
    }
  }
  return open;
}

std::vector<Correspondence> PairLostParts(
    const OpenPoints& open, const std::vector<const ModelSample*>& astray,
    const WarpField& warp, const AssociationGates& gates) {
  if (astray.empty() || open.points.empty()) return {};
  std::vector<Eigen::Vector3f> warped;
  warped.reserve(astray.size());
  for (const ModelSample* sample : astray) {
    warped.push_back(warp.WarpPoint(sample->skinning, sample->point));
  }
  const NearestPoint tree(warped);
  const auto min_cosine = static_cast<float>(std::cos(gates.normal_angle));
  std::vector<Correspondence> lost;
  int nearest = -1;
  for (std::size_t i = 0; i < open.points.size(); ++i) {
    float distance = 0;
    nearest = tree.Find(open.points[i], nearest, &distance);
    const ModelSample& sample = *astray[nearest];
    Correspondence pair;
    pair.warped_normal = warp.WarpNormal(sample.skinning, sample.normal);
    if (distance > gates.lost_distance ||
        pair.warped_normal.dot(open.normals[i]) < min_cosine) {
      continue;
    }
    pair.model = sample;
    pair.target = open.points[i];
    pair.target_normal = open.normals[i];
    pair.weight = open.weights[i];
    lost.push_back(pair);
  }
  return lost;
}

}  // namespace splitfusion
