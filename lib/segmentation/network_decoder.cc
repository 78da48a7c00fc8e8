#include "splitfusion/lib/segmentation/network_decoder.h"

#include "splitfusion/lib/segmentation/yolact_decoder.h"
#include "splitfusion/lib/segmentation/yolov8seg_decoder.h"

namespace splitfusion {

void DecoderOptions::Check() const {
  CheckOption(score_threshold >= 0 && score_threshold <= 1, "score_threshold",
              score_threshold, "0..1");
  CheckOption(nms_threshold > 0 && nms_threshold <= 1, "nms_threshold",
              nms_threshold, "above 0, at most 1");
  CheckOption(top_k >= 1, "top_k", top_k, ">= 1");
}

DecoderRegistry BuiltinDecoders() {
  DecoderRegistry registry("decoder");
  registry.Register("yolact", MakeYolactDecoder);
  registry.Register("yolov8seg", MakeYolov8SegDecoder);
  return registry;
}

}  // namespace splitfusion
