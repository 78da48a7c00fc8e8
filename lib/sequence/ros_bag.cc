#include "splitfusion/lib/sequence/ros_bag.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";
constexpr std::uint32_t kMaxHeader = 1 << 20;  // Bytes.

/// Values of the field `op`.
enum RecordKind { kMessage = 2, kChunk = 5, kConnection = 7 };

using Fields = std::map<std::string, std::string>;

/// Fields "name=value", each after its length.
Fields FieldsOf(const std::string& bytes) {
  Fields fields;
  std::size_t at = 0;
  while (at + 4 <= bytes.size()) {
    std::uint32_t size = 0;
    std::memcpy(&size, &bytes[at], sizeof(size));
    at += sizeof(size);
    if (size > bytes.size() - at) break;
    const std::string field = bytes.substr(at, size);
    at += size;
    const std::size_t equals = field.find('=');
    if (equals == std::string::npos) continue;
    fields[field.substr(0, equals)] = field.substr(equals + 1);
  }
  return fields;
}

/// A number of a field; 0 if there is none of that size.
template <typename Number>
Number NumberIn(const Fields& fields, const std::string& name) {
  const auto found = fields.find(name);
  Number number = 0;
  if (found != fields.end() && found->second.size() == sizeof(number)) {
    std::memcpy(&number, found->second.data(), sizeof(number));
  }
  return number;
}

std::string TextIn(const Fields& fields, const std::string& name) {
  const auto found = fields.find(name);
  return found == fields.end() ? "" : found->second;
}

}  // namespace

/// Records, one after the other: header, then data, each after its length.
class RosBag::Records {
 public:
  explicit Records(const std::string& path) : path_(path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) {
      throw InputError(path + ": no such file: expected a .bag of ROS 1");
    }
    size_ = std::filesystem::file_size(path, error);
    stream_.open(path, std::ios::binary);
    if (error || !stream_) throw InputError(path + ": cannot be opened");
  }

  std::uint64_t size() const { return size_; }

  std::string Read(std::uint64_t offset, std::uint64_t count) {
    if (offset > size_ || count > size_ - offset) Fail();
    std::string bytes(count, '\0');
    stream_.seekg(static_cast<std::streamoff>(offset));
    stream_.read(bytes.data(), static_cast<std::streamsize>(count));
    if (static_cast<std::uint64_t>(stream_.gcount()) != count) Fail();
    return bytes;
  }

  std::uint32_t ReadLength(std::uint64_t offset) {
    std::uint32_t length = 0;
    std::memcpy(&length, Read(offset, sizeof(length)).data(), sizeof(length));
    return length;
  }

  [[noreturn]] void Fail() const {
    throw InputError(path_ + ": " + std::to_string(size_) +
                     " bytes that are no .bag of ROS 1, version 2.0, or a "
                     "truncated one");
  }

  [[noreturn]] void FailAsCompressed(const std::string& how) const {
    throw InputError(path_ + ": compressed by " + how +
                     ": expected none, as after 'rosbag decompress'");
  }

 private:
  std::string path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
};

RosBag::RosBag(const std::string& path) : path_(path) {
  Records records(path);
  const std::uint64_t begin = sizeof(kMagic) - 1;
  if (records.size() < begin || records.Read(0, begin) != kMagic) {
    records.Fail();
  }
  Scan(&records, begin, records.size(), /*is_chunk=*/false);
}

void RosBag::Scan(Records* records, std::uint64_t begin, std::uint64_t end,
                  bool is_chunk) {
  for (std::uint64_t at = begin; at < end;) {
    const std::uint32_t header_size = records->ReadLength(at);
    if (header_size > kMaxHeader) records->Fail();
    const Fields header = FieldsOf(records->Read(at + 4, header_size));
    at += 4 + std::uint64_t{header_size};
    const std::uint32_t size = records->ReadLength(at);
    at += 4;
    if (at > end || size > end - at) records->Fail();
    const int kind = NumberIn<std::uint8_t>(header, "op");
    if (kind == kConnection) {
      const Fields data = FieldsOf(records->Read(at, size));
      const std::string topic = TextIn(header, "topic");
      topic_of_[NumberIn<std::uint32_t>(header, "conn")] = topic;
      topics_[topic].type = TextIn(data, "type");
    } else if (kind == kMessage) {
      const auto topic =
          topic_of_.find(NumberIn<std::uint32_t>(header, "conn"));
      if (topic == topic_of_.end()) records->Fail();
      topics_[topic->second].offsets.push_back(at);
      topics_[topic->second].bytes.push_back(size);
    } else if (kind == kChunk && !is_chunk) {
      const std::string compression = TextIn(header, "compression");
      if (compression != "none") records->FailAsCompressed(compression);
      Scan(records, at, at + size, /*is_chunk=*/true);
    }
    at += size;
  }
}

std::string RosBag::Message(const Topic& topic, int i,
                            std::uint32_t most) const {
  return Records(path_).Read(topic.offsets.at(i),
                             std::min(topic.bytes.at(i), most));
}

}  // namespace splitfusion
