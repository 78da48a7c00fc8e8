#include "splitfusion/lib/sequence/internal/ros_bag_check.h"

#include <ros/exception.h>
#include <rosbag/chunked_file.h>
#include <rosbag/constants.h>

#include <algorithm>
#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <string_view>
#include <vector>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
// Bytes, decompressed; those that rosbag writes have 768 KiB, or one message.
constexpr std::uint64_t kMaxBagChunk = 1 << 28;

/// A record: fields "name=value", then data.
struct BagRecord {
  std::uint64_t begin = 0;  // Within the bytes that it is of.
  std::map<std::string_view, std::string_view> fields;
  std::string_view data;
};

/// Goes through the bytes of one bag.
class BagCheck {
 public:
  explicit BagCheck(const std::string& path) : path_(path) {}

  void Run(std::string_view bytes) {
    size_ = bytes.size();
    if (bytes.substr(0, kBagMagic.size()) != kBagMagic) Fail();
    BagRecord record;
    for (std::uint64_t at = kBagMagic.size(); at < bytes.size();) {
      at = Take(bytes, at, &record);
      starts_.push_back(record.begin);
      CheckRecord(record);
    }
    starts_.push_back(bytes.size());
    if (!Contains(starts_, index_)) Fail();
    for (const std::uint64_t chunk : named_chunks_) {
      if (!Contains(chunks_, chunk)) Fail();
    }
  }

 private:
  using Offsets = std::vector<std::uint64_t>;  // Ascending.

  static bool Contains(const Offsets& offsets, std::uint64_t offset) {
    return std::binary_search(offsets.begin(), offsets.end(), offset);
  }

  [[noreturn]] void Fail() const {
    throw InputError(path_ + ": " + std::to_string(size_) +
                     " bytes that are no .bag of ROS 1, version 2.0, or a "
                     "truncated one");
  }

  /// What follows its length at `*at`; goes past it.
  std::string_view TakeSized(std::string_view bytes, std::uint64_t* at) const {
    std::uint32_t length = 0;
    if (bytes.size() - *at < sizeof(length)) Fail();
    std::memcpy(&length, &bytes[*at], sizeof(length));
    *at += sizeof(length);
    if (bytes.size() - *at < length) Fail();
    *at += length;
    return bytes.substr(*at - length, length);
  }

  /// Returns the offset after the record at `at`.
  std::uint64_t Take(std::string_view bytes, std::uint64_t at,
                     BagRecord* record) const {
    record->begin = at;
    record->fields = FieldsOf(TakeSized(bytes, &at));
    record->data = TakeSized(bytes, &at);
    return at;
  }

  std::map<std::string_view, std::string_view> FieldsOf(
      std::string_view header) const {
    std::map<std::string_view, std::string_view> fields;
    for (std::uint64_t at = 0; at < header.size();) {
      const std::string_view field = TakeSized(header, &at);
      const std::size_t equals = field.find('=');
      if (equals == std::string_view::npos) Fail();
      fields[field.substr(0, equals)] = field.substr(equals + 1);
    }
    return fields;
  }

  template <typename Number>
  Number NumberIn(const BagRecord& record, const std::string& name) const {
    const auto found = record.fields.find(name);
    Number number = 0;
    if (found == record.fields.end() ||
        found->second.size() != sizeof(number)) {
      Fail();
    }
    std::memcpy(&number, found->second.data(), sizeof(number));
    return number;
  }

  std::uint8_t KindOf(const BagRecord& record) const {
    return NumberIn<std::uint8_t>(record, rosbag::OP_FIELD_NAME);
  }

  void CheckCount(const BagRecord& record, std::uint64_t entry_size) const {
    const std::uint64_t count =
        NumberIn<std::uint32_t>(record, rosbag::COUNT_FIELD_NAME);
    if (record.data.size() != count * entry_size) Fail();
  }

  void CheckRecord(const BagRecord& record) {
    switch (KindOf(record)) {
      case rosbag::OP_FILE_HEADER:
        return CheckFileHeader(record);
      case rosbag::OP_CONNECTION:
        FieldsOf(record.data);
        return;
      case rosbag::OP_CHUNK:
        chunks_.push_back(record.begin);
        return CheckChunk(record);
      case rosbag::OP_INDEX_DATA:
        return CheckIndex(record);
      case rosbag::OP_CHUNK_INFO:
        CheckCount(record, 2 * sizeof(std::uint32_t));
        named_chunks_.push_back(
            NumberIn<std::uint64_t>(record, rosbag::CHUNK_POS_FIELD_NAME));
        return;
    }
  }

  void CheckFileHeader(const BagRecord& record) {
    if (record.fields.count(rosbag::ENCRYPTOR_FIELD_NAME) > 0) {
      throw InputError(path_ + ": is encrypted: expected a bag that is not");
    }
    index_ = NumberIn<std::uint64_t>(record, rosbag::INDEX_POS_FIELD_NAME);
    if (index_ == 0) {
      throw InputError(path_ +
                       ": has no index, as if its recording was interrupted: "
                       "expected one, as after 'rosbag reindex'");
    }
  }

  /// Finds where its messages are.
  void CheckChunk(const BagRecord& chunk) {
    std::vector<std::uint8_t> buffer;
    const std::string_view bytes = Decompress(chunk, &buffer);
    messages_.clear();
    Offsets connections;
    BagRecord record;
    for (std::uint64_t at = 0; at < bytes.size();) {
      at = Take(bytes, at, &record);
      const std::uint8_t kind = KindOf(record);
      if (kind == rosbag::OP_CONNECTION) connections.push_back(record.begin);
      if (kind != rosbag::OP_MSG_DATA) continue;
      // The index may name the connection before a message.
      messages_.insert(messages_.end(), connections.begin(), connections.end());
      connections.clear();
      messages_.push_back(record.begin);
    }
  }

  std::string_view Decompress(const BagRecord& chunk,
                              std::vector<std::uint8_t>* buffer) const {
    const auto found = chunk.fields.find(rosbag::COMPRESSION_FIELD_NAME);
    if (found == chunk.fields.end()) Fail();
    const auto size = NumberIn<std::uint32_t>(chunk, rosbag::SIZE_FIELD_NAME);
    if (found->second == rosbag::COMPRESSION_NONE) return chunk.data;
    const bool is_bz2 = found->second == rosbag::COMPRESSION_BZ2;
    if (!is_bz2 && found->second != rosbag::COMPRESSION_LZ4) Fail();
    if (size > kMaxBagChunk) Fail();
    buffer->resize(size);
    // The library has no const.
    auto* source = const_cast<char*>(chunk.data.data());
    try {
      rosbag::ChunkedFile().decompress(
          is_bz2 ? rosbag::compression::BZ2 : rosbag::compression::LZ4,
          buffer->data(), size, reinterpret_cast<std::uint8_t*>(source),
          static_cast<unsigned>(chunk.data.size()));
    } catch (const ros::Exception& error) {
      throw InputError(path_ + ": a chunk of " + std::to_string(size) +
                       " bytes: " + error.what());
    }
    return {reinterpret_cast<const char*>(buffer->data()), size};
  }

  /// Of the last chunk.
  void CheckIndex(const BagRecord& record) const {
    constexpr std::size_t kEntry = 12;  // Time, then offset.
    CheckCount(record, kEntry);
    for (std::size_t at = 0; at < record.data.size(); at += kEntry) {
      std::uint32_t offset = 0;
      std::memcpy(&offset, &record.data[at + 8], sizeof(offset));
      if (!Contains(messages_, offset)) Fail();
    }
  }

  const std::string& path_;
  std::uint64_t size_ = 0;
  std::uint64_t index_ = 0;  // Where the records after all chunks begin.
  Offsets starts_;           // Of all records, and the end.
  Offsets chunks_;
  Offsets messages_;                         // Of the last chunk.
  std::vector<std::uint64_t> named_chunks_;  // By the index.
};

}  // namespace

void CheckRosBag(const std::string& path) {
  namespace bip = boost::interprocess;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError(path + ": no such file: expected a .bag of ROS 1");
  }
  BagCheck check(path);
  if (std::filesystem::file_size(path, error) == 0) return check.Run({});
  try {
    const bip::file_mapping file(path.c_str(), bip::read_only);
    const bip::mapped_region region(file, bip::read_only);
    check.Run(
        {static_cast<const char*>(region.get_address()), region.get_size()});
  } catch (const bip::interprocess_exception& failure) {
    throw InputError(path + ": cannot be opened: " + failure.what());
  }
}

}  // namespace splitfusion
