#include "splitfusion/lib/split/segment.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace splitfusion {
namespace {

void PaintCut(const Segment& segment, int label, LabelImage* labels,
              cv::Mat_<float>* strength) {
  const cv::Rect& crop = segment.evidence.crop;
  for (int v = 0; v < crop.height; ++v) {
    for (int u = 0; u < crop.width; ++u) {
      if (!segment.foreground(v, u)) continue;
      const cv::Point pixel(crop.x + u, crop.y + v);
      const float evidence = segment.evidence.evidence(v, u);
      if ((*labels)(pixel) > 0 && (*strength)(pixel) >= evidence) continue;
      (*labels)(pixel) = static_cast<std::uint16_t>(label);
      (*strength)(pixel) = evidence;
    }
  }
}

/// Drops the islands of one segment with fewer pixels than `min_island` from
/// the labels.
void DropIslands(const cv::Rect& crop, int label, int min_island,
                 LabelImage* labels) {
  LabelImage view = (*labels)(crop);
  cv::Mat islands, statistics, centers;
  const int count = cv::connectedComponentsWithStats(
      view == label, islands, statistics, centers, 8, CV_32S);
  std::vector<bool> drop(count, false);
  for (int i = 1; i < count; ++i) {
    drop[i] = statistics.at<int>(i, cv::CC_STAT_AREA) < min_island;
  }
  for (int v = 0; v < view.rows; ++v) {
    for (int u = 0; u < view.cols; ++u) {
      if (drop[islands.at<int>(v, u)]) view(v, u) = 0;
    }
  }
}

/// Where pixels without depth may belong to the segment, size of its crop.
cv::Mat_<uchar> ClosedOutline(const Segment& segment,
                              const LabelImage& predicted_labels) {
  const cv::Rect& crop = segment.evidence.crop;
  cv::Mat_<uchar> outline =
      segment.mask.empty()
          ? cv::Mat_<uchar>(predicted_labels(crop) == segment.surface)
          : cv::Mat_<uchar>(segment.mask(crop).clone());
  // The cut may have taken back parts that the detector missed.
  outline |= segment.foreground;
  cv::morphologyEx(
      outline, outline, cv::MORPH_CLOSE,
      cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(7, 7)));
  return outline;
}

void FillWithoutDepth(const cv::Rect& crop, const cv::Mat_<uchar>& outline,
                      int label, const cv::Mat& depth, LabelImage* labels) {
  for (int v = 0; v < crop.height; ++v) {
    for (int u = 0; u < crop.width; ++u) {
      const cv::Point pixel(crop.x + u, crop.y + v);
      if (outline(v, u) && depth.at<float>(pixel) <= 0 &&
          (*labels)(pixel) == 0) {
        (*labels)(pixel) = static_cast<std::uint16_t>(label);
      }
    }
  }
}

}  // namespace

SplitDecision MakeDecision(const std::string& action, const Segment& segment) {
  return {action, segment.surface, segment.class_name, segment.score,
          segment.iou};
}

cv::Mat_<uchar> MasksBut(int but, const std::vector<Segment>& segments,
                         cv::Size size) {
  cv::Mat_<uchar> masks(size, uchar(0));
  for (int i = 0; i < static_cast<int>(segments.size()); ++i) {
    if (i != but && !segments[i].mask.empty()) masks |= segments[i].mask;
  }
  return masks;
}

cv::Mat_<uchar> SegmentPixels(int index, const LabelImage& segment_labels) {
  return segment_labels == index + 1;
}

LabelImage ComposeSegments(const std::vector<Segment>& segments,
                           const LabelImage& predicted_labels,
                           const cv::Mat& depth, int min_island) {
  LabelImage labels(depth.size(), 0);
  cv::Mat_<float> strength(depth.size(), 0.0f);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    PaintCut(segments[i], static_cast<int>(i) + 1, &labels, &strength);
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const cv::Rect& crop = segments[i].evidence.crop;
    if (crop.area() == 0) continue;
    const int label = static_cast<int>(i) + 1;
    DropIslands(crop, label, min_island, &labels);
    FillWithoutDepth(crop, ClosedOutline(segments[i], predicted_labels), label,
                     depth, &labels);
  }
  return labels;
}

}  // namespace splitfusion
