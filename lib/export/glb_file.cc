#include "splitfusion/lib/export/glb_file.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kUnsignedShort = 5123;  // Format.
constexpr int kUnsignedInt = 5125;    // Format.
constexpr int kFloat = 5126;          // Format.
/// Of a file and its two chunks: what they begin with.
constexpr std::uint32_t kGlbMagic = 0x46546C67;    // Format.
constexpr std::uint32_t kGlbVersion = 2;           // Format.
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;   // Format.
constexpr std::uint32_t kBytesChunk = 0x004E4942;  // Format.

int Components(const std::string& type) {
  if (type == "MAT4") return 16;  // Format.
  return type == "SCALAR" ? 1 : type.back() - '0';
}

/// Sets `min` and `max` of an accessor.
template <typename T>
void AddBounds(const std::vector<T>& values, int components, Json* accessor) {
  Json low = Json::array(), high = Json::array();
  for (int c = 0; c < components; ++c) {
    T least = std::numeric_limits<T>::max();
    T most = std::numeric_limits<T>::lowest();
    for (std::size_t i = c; i < values.size(); i += components) {
      least = std::min(least, values[i]);
      most = std::max(most, values[i]);
    }
    low.push_back(least);
    high.push_back(most);
  }
  (*accessor)["min"] = low;
  (*accessor)["max"] = high;
}

void WriteNumbers(const std::vector<std::uint32_t>& values, std::ostream* out) {
  out->write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(values[0])));
}

}  // namespace

template <typename T>
int GlbFile::AddArray(const std::vector<T>& values, int component_type,
                      const GlbArrayKind& kind) {
  // Room for the JSON, which grows with the nodes.
  constexpr std::size_t kMost = 0xF0000000;  // Format.
  const std::size_t size = values.size() * sizeof(T);
  if (bytes_.size() + size > kMost) {
    throw InputError(
        "the glTF file would be larger than 4 GiB: expected fewer frames "
        "(--every) or surfaces (--surfaces), or no --bake");
  }
  const int components = Components(kind.type);
  Json view = {
      {"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}};
  if (kind.target != 0) view["target"] = kind.target;
  Json accessor = {{"bufferView", views_.size()},
                   {"componentType", component_type},
                   {"count", values.size() / components},
                   {"type", kind.type}};
  if (kind.normalized) accessor["normalized"] = true;
  if (kind.bounds) AddBounds(values, components, &accessor);
  views_.push_back(std::move(view));
  bytes_.append(reinterpret_cast<const char*>(values.data()), size);
  bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
  accessors_.push_back(std::move(accessor));
  return static_cast<int>(accessors_.size()) - 1;
}

int GlbFile::Add(const std::vector<float>& values, const GlbArrayKind& kind) {
  return AddArray(values, kFloat, kind);
}

int GlbFile::Add(const std::vector<std::uint16_t>& values,
                 const GlbArrayKind& kind) {
  return AddArray(values, kUnsignedShort, kind);
}

int GlbFile::Add(const std::vector<std::uint32_t>& values,
                 const GlbArrayKind& kind) {
  return AddArray(values, kUnsignedInt, kind);
}

int GlbFile::Append(const std::string& name, Json object) {
  json[name].push_back(std::move(object));
  return static_cast<int>(json[name].size()) - 1;
}

void GlbFile::Write(const std::string& path) const {
  Json whole = json;
  whole["accessors"] = accessors_;
  whole["bufferViews"] = views_;
  whole["buffers"] = Json::array();
  whole["buffers"].push_back({{"byteLength", bytes_.size()}});
  std::string text = JsonText(whole);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto text_size = static_cast<std::uint32_t>(text.size());
  const auto size = static_cast<std::uint32_t>(bytes_.size());
  WriteFileAtomically(path, [&](std::ostream& out) {
    constexpr std::uint32_t kHeads = 28;  // Format.
    WriteNumbers({kGlbMagic, kGlbVersion, kHeads + text_size + size}, &out);
    WriteNumbers({text_size, kJsonChunk}, &out);
    out << text;
    WriteNumbers({size, kBytesChunk}, &out);
    out << bytes_;
  });
}

}  // namespace splitfusion
