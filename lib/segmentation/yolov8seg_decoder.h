#ifndef SPLITFUSION_LIB_SEGMENTATION_YOLOV8SEG_DECODER_H_
#define SPLITFUSION_LIB_SEGMENTATION_YOLOV8SEG_DECODER_H_

#include <memory>

#include "splitfusion/lib/segmentation/network_decoder.h"

namespace splitfusion {

/// YOLOv8-seg (and YOLO11-seg, whose outputs are the same): letterbox with
/// grey 114, RGB / 255. Width and height of the input must be multiples of 32.
/// Its outputs are those of Ultralytics' export, with C classes, M prototypes
/// and A anchors:
///  - `output0`, 1 x (4 + C + M) x A: cx, cy, w, h in input pixels, class
///    probabilities, mask coefficients;
///  - `output1`, 1 x M x H/4 x W/4, the prototypes.
///
/// Instances are the best class of every anchor, after non-maximum suppression
/// within each class, with masks sigmoid(coefficients * prototypes) cut by
/// their box.
std::unique_ptr<NetworkDecoder> MakeYolov8SegDecoder();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_YOLOV8SEG_DECODER_H_
