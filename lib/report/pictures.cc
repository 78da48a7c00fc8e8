#include "splitfusion/lib/report/pictures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

const cv::Vec3b kWhite(255, 255, 255);
const cv::Vec3b kBlack(0, 0, 0);
constexpr float kNear = 0.4f, kFar = 5.0f;  // Metres.
constexpr float kMaxError = 0.05f;          // Metres.
constexpr double kOpacity = 0.5;

void CheckImage(const cv::Mat& image, int type, const std::string& name,
                cv::Size size) {
  if (image.type() == type && image.size() == size && !image.empty()) return;
  throw InputError("picture: " + name + " is " + std::to_string(image.cols) +
                   "x" + std::to_string(image.rows) + " " +
                   cv::typeToString(image.type()) + "; expected " +
                   std::to_string(size.width) + "x" +
                   std::to_string(size.height) + " " + cv::typeToString(type));
}

/// 0..255 by linear scaling of [low, high]; `valid` receives 255 or 0.
cv::Mat TurboPicture(const cv::Mat& values, const cv::Mat& valid, float low,
                     float high) {
  cv::Mat scaled;
  const double scale = 255.0 / (high - low);
  values.convertTo(scaled, CV_8U, scale, -low * scale);
  cv::Mat picture;
  cv::applyColorMap(scaled, picture, cv::COLORMAP_TURBO);
  picture.setTo(kBlack, ~valid);
  return picture;
}

cv::Vec3b NormalColor(const cv::Vec3f& normal) {
  const float norm = std::sqrt(normal.dot(normal));
  if (!std::isfinite(norm) || norm < 0.5f) return kWhite;
  const auto channel = [](float v) {
    return cv::saturate_cast<uchar>(127.5f * (1.0f + v));
  };
  return {channel(-normal[2] / norm), channel(-normal[1] / norm),
          channel(normal[0] / norm)};
}

/// Whether a neighbour to the right or below has another label.
bool IsOutline(const cv::Mat_<ushort>& labels, int row, int column) {
  const ushort label = labels(row, column);
  const int right = std::min(column + 1, labels.cols - 1);
  const int below = std::min(row + 1, labels.rows - 1);
  return labels(row, right) != label || labels(below, column) != label;
}

}  // namespace

cv::Vec3b LabelColor(int id) {
  if (id == 0) return {128, 128, 128};
  // Hues a golden angle apart never come close for neighbouring ids.
  const double hue = std::fmod(0.08 + 0.6180339887 * (id - 1), 1.0) * 180.0;
  const cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar(hue, 200, 240));
  cv::Mat bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  return bgr.at<cv::Vec3b>(0, 0);
}

cv::Mat NormalPicture(const cv::Mat& normals) {
  CheckImage(normals, CV_32FC3, "normals", normals.size());
  cv::Mat picture(normals.size(), CV_8UC3);
  for (int row = 0; row < normals.rows; ++row) {
    for (int column = 0; column < normals.cols; ++column) {
      picture.at<cv::Vec3b>(row, column) =
          NormalColor(normals.at<cv::Vec3f>(row, column));
    }
  }
  return picture;
}

cv::Mat DepthPicture(const cv::Mat& depth) {
  CheckImage(depth, CV_32FC1, "depth", depth.size());
  return TurboPicture(depth, depth > 0, kNear, kFar);
}

cv::Mat ErrorPicture(const cv::Mat& model_depth, const cv::Mat& live_depth) {
  CheckImage(model_depth, CV_32FC1, "model depth", live_depth.size());
  CheckImage(live_depth, CV_32FC1, "live depth", live_depth.size());
  cv::Mat error;
  cv::absdiff(model_depth, live_depth, error);
  return TurboPicture(error, (model_depth > 0) & (live_depth > 0), 0,
                      kMaxError);
}

cv::Mat LabelPicture(const cv::Mat& color, const cv::Mat& labels) {
  CheckImage(color, CV_8UC3, "color", color.size());
  CheckImage(labels, CV_16UC1, "labels", color.size());
  const cv::Mat_<ushort> ids = labels;
  cv::Mat picture = color.clone();
  picture.forEach<cv::Vec3b>([&](cv::Vec3b& pixel, const int* at) {
    const int id = ids(at[0], at[1]);
    if (id == 0) return;
    const double share = IsOutline(ids, at[0], at[1]) ? 1.0 : kOpacity;
    pixel = cv::Vec3b(cv::Vec3d(pixel) * (1.0 - share) +
                      cv::Vec3d(LabelColor(id)) * share);
  });
  return picture;
}

cv::Mat CompositePicture(const cv::Mat& model_color,
                         const cv::Mat& model_depth) {
  CheckImage(model_color, CV_8UC3, "model color", model_color.size());
  CheckImage(model_depth, CV_32FC1, "model depth", model_color.size());
  cv::Mat picture = model_color.clone();
  picture.setTo(kWhite, ~(model_depth > 0));
  return picture;
}

}  // namespace splitfusion
