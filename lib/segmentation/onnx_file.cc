#include "splitfusion/lib/segmentation/onnx_file.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string_view>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

// Field numbers of onnx.proto.
constexpr int kModelGraph = 7;
constexpr int kGraphInitializer = 5;
constexpr int kGraphInput = 11;
constexpr int kGraphOutput = 12;
constexpr int kValueName = 1;
constexpr int kValueType = 2;
constexpr int kTypeTensor = 1;
constexpr int kTensorTypeShape = 2;
constexpr int kShapeDimension = 1;
constexpr int kDimensionValue = 1;
constexpr int kTensorDataType = 2;
constexpr int kTensorName = 8;
constexpr std::uint64_t kFloat16 = 10;

/// Walks over the fields of one protobuf message.
class MessageReader {
 public:
  explicit MessageReader(std::string_view bytes) : rest_(bytes) {}

  /// Goes to the next field; false at the end or if the bytes are broken.
  bool Next() {
    if (rest_.empty()) return false;
    const std::uint64_t key = Varint();
    field_ = static_cast<int>(key >> 3);
    value_ = 0;
    bytes_ = {};
    switch (key & 7) {
      case 0:
        value_ = Varint();
        break;
      case 1:
        bytes_ = Take(8);
        break;
      case 2:
        bytes_ = Take(Varint());
        break;
      case 5:
        bytes_ = Take(4);
        break;
      default:
        broken_ = true;
    }
    return !broken_;
  }

  bool broken() const { return broken_; }
  int field() const { return field_; }
  std::uint64_t value() const { return value_; }
  std::string_view bytes() const { return bytes_; }
  std::string text() const { return std::string(bytes_); }

 private:
  std::uint64_t Varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
      const auto byte = static_cast<unsigned char>(rest_.front());
      rest_.remove_prefix(1);
      value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80) return value;
    }
    broken_ = true;
    return 0;
  }

  std::string_view Take(std::uint64_t count) {
    if (count > rest_.size()) {
      broken_ = true;
      return {};
    }
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }

  std::string_view rest_;
  bool broken_ = false;
  int field_ = 0;
  std::uint64_t value_ = 0;
  std::string_view bytes_;
};

/// The sub-message in `field`; empty if there is none.
std::string_view Submessage(std::string_view message, int field) {
  MessageReader reader(message);
  while (reader.Next()) {
    if (reader.field() == field) return reader.bytes();
  }
  return {};
}

std::vector<int> ParseShape(std::string_view type) {
  MessageReader shape(
      Submessage(Submessage(type, kTypeTensor), kTensorTypeShape));
  std::vector<int> lengths;
  while (shape.Next()) {
    if (shape.field() != kShapeDimension) continue;
    lengths.push_back(0);
    MessageReader dimension(shape.bytes());
    while (dimension.Next()) {
      if (dimension.field() != kDimensionValue) continue;
      lengths.back() = static_cast<int>(dimension.value());
    }
  }
  return lengths;
}

OnnxValue ParseValue(std::string_view bytes) {
  OnnxValue value;
  MessageReader reader(bytes);
  while (reader.Next()) {
    if (reader.field() == kValueName) value.name = reader.text();
    if (reader.field() == kValueType) value.shape = ParseShape(reader.bytes());
  }
  return value;
}

/// Name of an initialiser.
///
/// @throw InputError if it is of half precision.
std::string ParseInitializer(std::string_view bytes, const std::string& path) {
  std::string name;
  bool half = false;
  MessageReader reader(bytes);
  while (reader.Next()) {
    if (reader.field() == kTensorName) name = reader.text();
    if (reader.field() == kTensorDataType) half = reader.value() == kFloat16;
  }
  if (half) {
    throw InputError(path + ": weights '" + name +
                     "' are FLOAT16: expected FLOAT32, an export without half "
                     "precision (docs/segmentation.md)");
  }
  return name;
}

bool ParseGraph(std::string_view bytes, const std::string& path,
                OnnxGraph* graph) {
  std::set<std::string> weights;
  MessageReader reader(bytes);
  while (reader.Next()) {
    if (reader.field() == kGraphInitializer) {
      weights.insert(ParseInitializer(reader.bytes(), path));
    } else if (reader.field() == kGraphInput) {
      graph->inputs.push_back(ParseValue(reader.bytes()));
    } else if (reader.field() == kGraphOutput) {
      graph->outputs.push_back(ParseValue(reader.bytes()));
    }
  }
  const auto is_weight = [&](const OnnxValue& v) {
    return weights.count(v.name) > 0;
  };
  graph->inputs.erase(
      std::remove_if(graph->inputs.begin(), graph->inputs.end(), is_weight),
      graph->inputs.end());
  return !reader.broken() && !graph->inputs.empty() && !graph->outputs.empty();
}

}  // namespace

OnnxGraph ReadOnnxGraph(const std::string& bytes, const std::string& path) {
  OnnxGraph graph;
  bool found = false;
  MessageReader model(bytes);
  while (model.Next()) {
    if (model.field() != kModelGraph) continue;
    found = ParseGraph(model.bytes(), path, &graph);
  }
  if (!found || model.broken()) {
    throw InputError(path +
                     ": not an ONNX model, or a truncated one: expected a "
                     "graph with inputs and outputs");
  }
  return graph;
}

}  // namespace splitfusion
