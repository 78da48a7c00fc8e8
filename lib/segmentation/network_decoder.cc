#include "splitfusion/lib/segmentation/network_decoder.h"

#include <functional>
#include <map>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/segmentation/yolact_decoder.h"
#include "splitfusion/lib/segmentation/yolov8seg_decoder.h"

namespace splitfusion {
namespace {

using Factory = std::function<std::unique_ptr<NetworkDecoder>()>;

const std::map<std::string, Factory>& Decoders() {
  static const std::map<std::string, Factory> decoders = {
      {"yolact", MakeYolactDecoder}, {"yolov8seg", MakeYolov8SegDecoder}};
  return decoders;
}

}  // namespace

void DecoderOptions::Check() const {
  CheckOption(score_threshold >= 0 && score_threshold <= 1, "score_threshold",
              score_threshold, "0..1");
  CheckOption(nms_threshold > 0 && nms_threshold <= 1, "nms_threshold",
              nms_threshold, "above 0, at most 1");
  CheckOption(top_k >= 1, "top_k", top_k, ">= 1");
}

std::vector<std::string> DecoderNames() {
  std::vector<std::string> names;
  for (const auto& [name, factory] : Decoders()) names.push_back(name);
  return names;
}

std::unique_ptr<NetworkDecoder> MakeDecoder(const std::string& name) {
  const auto found = Decoders().find(name);
  std::string known;
  for (const std::string& n : DecoderNames()) {
    known += (known.empty() ? "" : " or ") + n;
  }
  CheckOption(found != Decoders().end(), "decoder", name.empty() ? "''" : name,
              known);
  return found->second();
}

}  // namespace splitfusion
