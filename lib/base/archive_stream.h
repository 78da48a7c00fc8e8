#ifndef SPLITFUSION_LIB_BASE_ARCHIVE_STREAM_H_
#define SPLITFUSION_LIB_BASE_ARCHIVE_STREAM_H_

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <istream>
#include <ostream>
#include <string>
#include <vector>

namespace splitfusion {

/// Writes values one after the other into a binary stream, as they lie in
/// memory. What may be written: see lib/base/archive.h.
class ArchiveWriter {
 public:
  /// Tells functions for both directions which one is asked for.
  static constexpr bool kReads = false;

  /// `out` must outlive this.
  explicit ArchiveWriter(std::ostream* out) : out_(out), buffer_(kBuffer) {}
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  /// Writes values in their order.
  template <typename... T>
  void operator()(const T&... values);

  /// Writes bytes.
  void Raw(const void* data, std::size_t bytes) {
    if (bytes > buffer_.size() - used_) return WriteLarge(data, bytes);
    if (bytes > 0) std::memcpy(buffer_.data() + used_, data, bytes);
    used_ += bytes;
  }

  /// Writes the number of things that follow, each of at least so many bytes.
  std::uint64_t Count(std::uint64_t count, std::size_t /*bytes*/) {
    Raw(&count, sizeof(count));
    return count;
  }

  /// Marks the place where the values of something begin.
  void Section(const std::string& name);

  /// Hands all that was written to the stream; must be called at the end.
  void Flush();

 private:
  static constexpr std::size_t kBuffer = std::size_t{1} << 20;

  void WriteLarge(const void* data, std::size_t bytes);

  std::ostream* out_;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
};

/// Reads what an ArchiveWriter wrote, in the same order. Whatever the stream
/// holds, nothing is made that is larger than what is left of it can fill.
class ArchiveReader {
 public:
  /// Tells functions for both directions which one is asked for.
  static constexpr bool kReads = true;

  /// Reads the next `bytes` of `in`, which must outlive this; `name`: of the
  /// file, for messages.
  ArchiveReader(std::istream* in, std::uint64_t bytes, std::string name)
      : in_(in), in_stream_(bytes), name_(std::move(name)), buffer_(kBuffer) {}
  ArchiveReader(const ArchiveReader&) = delete;
  ArchiveReader& operator=(const ArchiveReader&) = delete;

  /// Reads values in their order, in place of what they were.
  ///
  /// @throw InputError that names file and section if the archive ends early or
  ///     does not hold what is asked for.
  template <typename... T>
  void operator()(T&... values);

  /// Reads bytes. @throw InputError if there are not so many.
  void Raw(void* data, std::size_t bytes) {
    if (bytes > end_ - begin_) return ReadLarge(data, bytes);
    if (bytes > 0) std::memcpy(data, buffer_.data() + begin_, bytes);
    begin_ += bytes;
  }

  /// Number of things that follow, each of at least `bytes` > 0 bytes.
  ///
  /// @throw InputError if so many do not fit into what is left.
  std::uint64_t Count(std::uint64_t /*count*/, std::size_t bytes);

  /// @throw InputError unless the section of this name begins here.
  void Section(const std::string& name);

  /// Bytes that have not been read yet.
  std::uint64_t left() const { return in_stream_ + (end_ - begin_); }

  /// Throws an InputError that names file and section: "<file>: section
  /// '<section>': <what>".
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  static constexpr std::size_t kBuffer = std::size_t{1} << 20;

  void ReadLarge(void* data, std::size_t bytes);
  void FromStream(char* data, std::size_t bytes);

  std::istream* in_;
  std::uint64_t in_stream_;  // Bytes that are not in the buffer yet.
  std::string name_;
  std::string section_ = "beginning";  // Where reading is.
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // Of what is in the buffer.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_ARCHIVE_STREAM_H_
