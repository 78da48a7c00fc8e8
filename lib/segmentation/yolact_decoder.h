#ifndef SPLITFUSION_LIB_SEGMENTATION_YOLACT_DECODER_H_
#define SPLITFUSION_LIB_SEGMENTATION_YOLACT_DECODER_H_

#include <memory>
#include <vector>

#include "splitfusion/lib/segmentation/network_decoder.h"

namespace splitfusion {

/// Fast NMS (Bolya et al. 2019): indices of the boxes whose overlap (IoU) with
/// every better box, be it kept or not, is at most `threshold`.
///
/// @param boxes best score first.
std::vector<int> FastNms(const std::vector<cv::Rect2f>& boxes,
                         double threshold);

/// YOLACT (the paper's network): the frame stretched to a square of 550
/// pixels, colours normalised, RGB. Width and height of the input must be
/// equal. Its outputs are those before its own detection step, with P priors, C
/// classes and M prototypes; each may have a batch dimension of 1 in front:
///  - `loc`, P x 4: boxes against the priors;
///  - `conf`, P x (1 + C): softmax, column 0 background;
///  - `mask`, P x M: coefficients after tanh;
///  - `proto`, H x W x M: prototypes after ReLU.
///
/// Instances are priors whose best class is above 0.05, after fast non-maximum
/// suppression of the best 200 of each class, with masks
/// sigmoid(proto * mask^T) cropped to the box (one prototype pixel wider).
std::unique_ptr<NetworkDecoder> MakeYolactDecoder();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_YOLACT_DECODER_H_
