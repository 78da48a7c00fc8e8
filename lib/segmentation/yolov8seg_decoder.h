#ifndef SPLITFUSION_LIB_SEGMENTATION_YOLOV8SEG_DECODER_H_
#define SPLITFUSION_LIB_SEGMENTATION_YOLOV8SEG_DECODER_H_

#include <memory>
#include <vector>

#include "splitfusion/lib/segmentation/network_decoder.h"

namespace splitfusion {

/// Outputs of YOLOv8-seg as Ultralytics exports it, with C classes, M
/// prototypes and A anchors.
struct Yolov8SegOutputs {
  /// `output0`, 1 x (4 + C + M) x A: cx, cy, w, h in input pixels, class
  /// probabilities, mask coefficients.
  NetworkTensor detections;
  /// `output1`, 1 x M x H/4 x W/4.
  NetworkTensor prototypes;
};

/// Instances from the outputs: the best class of every anchor, non-maximum
/// suppression within each class, masks sigmoid(coefficients * prototypes) cut
/// by their box.
///
/// @throw InputError on a wrong shape.
std::vector<NetworkInstance> DecodeYolov8Seg(const Yolov8SegOutputs& outputs,
                                             const DecoderInput& input,
                                             const DecoderOptions& options);

/// YOLOv8-seg (and YOLO11-seg, whose outputs are the same): letterbox with
/// grey 114, RGB / 255. Width and height of the input must be multiples of 32.
std::unique_ptr<NetworkDecoder> MakeYolov8SegDecoder();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_YOLOV8SEG_DECODER_H_
