#ifndef SPLITFUSION_LIB_SPLIT_SEGMENT_H_
#define SPLITFUSION_LIB_SPLIT_SEGMENT_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/split/appearance.h"
#include "splitfusion/lib/split/split_result.h"
#include "splitfusion/lib/split/surface_prediction.h"
#include "splitfusion/lib/split/surface_prior.h"

namespace splitfusion {

/// One surface, or one detection that may become one, in one frame.
struct Segment {
  int surface = 0;             ///< Id; 0 for a newcomer.
  int tentative = -1;          ///< Its tentative track; -1 for a new one.
  Appearance appearance;       ///< Of the best detection.
  cv::Mat_<uchar> mask;        ///< Detected, HxW, 255 inside; empty if missed.
  std::string class_name;      ///< Of the best detection.
  double score = 0;            ///< Of the best detection; 0 if missed.
  double iou = 0;              ///< Of the best detection and the projection.
  SurfaceEvidence evidence;    ///< What the cut is made from.
  cv::Mat_<uchar> foreground;  ///< Cut, size of evidence.crop, 255 inside.
};

/// The decision `action` on a segment.
SplitDecision MakeDecision(const std::string& action, const Segment& segment);

/// Pixels in the mask of any segment but the one of index `but` (-1: of any at
/// all), 255; of this size.
cv::Mat_<uchar> MasksBut(int but, const std::vector<Segment>& segments,
                         cv::Size size);

/// Pixels of the segment of this index in the result of ComposeSegments(), 255.
cv::Mat_<uchar> SegmentPixels(int index, const LabelImage& segment_labels);

/// Joins the cuts of all segments: HxW, 1 + index of the segment that a pixel
/// belongs to, 0 = none. Where two claim a pixel the stronger evidence wins.
/// Islands of fewer than `min_island` pixels are dropped. Pixels without depth
/// take the detector's mask (the projected surface if there was no detection),
/// closed over small holes.
///
/// `depth`: HxW 32FC1, metres, 0 = none.
LabelImage ComposeSegments(const std::vector<Segment>& segments,
                           const LabelImage& predicted_labels,
                           const cv::Mat& depth, int min_island);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SEGMENT_H_
