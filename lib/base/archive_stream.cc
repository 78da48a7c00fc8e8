#include "splitfusion/lib/base/archive_stream.h"

#include <algorithm>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

void ArchiveWriter::Section(const std::string& name) {
  const auto size = static_cast<std::uint8_t>(name.size());
  Raw(&size, sizeof(size));
  Raw(name.data(), size);
}

void ArchiveWriter::Flush() {
  out_->write(buffer_.data(), static_cast<std::streamsize>(used_));
  used_ = 0;
}

void ArchiveWriter::WriteLarge(const void* data, std::size_t bytes) {
  Flush();
  if (bytes <= buffer_.size()) return Raw(data, bytes);
  out_->write(static_cast<const char*>(data),
              static_cast<std::streamsize>(bytes));
}

void ArchiveReader::Fail(const std::string& what) const {
  throw InputError(name_ + ": section '" + section_ + "': " + what);
}

std::uint64_t ArchiveReader::Count(std::uint64_t, std::size_t bytes) {
  std::uint64_t count = 0;
  Raw(&count, sizeof(count));
  if (count > left() / bytes) {
    Fail(std::to_string(count) + " values of " + std::to_string(bytes) +
         " bytes: expected at most the " + std::to_string(left()) +
         " bytes that are left");
  }
  return count;
}

void ArchiveReader::Section(const std::string& name) {
  std::uint8_t size = 0;
  Raw(&size, sizeof(size));
  std::string found(std::min<std::uint64_t>(size, left()), ' ');
  Raw(found.data(), found.size());
  if (found != name) Fail("ends where '" + name + "' was expected to follow");
  section_ = name;
}

void ArchiveReader::ReadLarge(void* data, std::size_t bytes) {
  if (bytes > left()) {
    Fail("ends early: expected " + std::to_string(bytes) + " bytes, " +
         std::to_string(left()) + " are left");
  }
  char* to = static_cast<char*>(data);
  const std::size_t buffered = end_ - begin_;
  std::copy_n(buffer_.data() + begin_, buffered, to);
  to += buffered, bytes -= buffered;
  begin_ = end_ = 0;
  if (bytes >= buffer_.size()) return FromStream(to, bytes);
  const std::size_t next = static_cast<std::size_t>(
      std::min<std::uint64_t>(buffer_.size(), in_stream_));
  FromStream(buffer_.data(), next);
  end_ = next;
  Raw(to, bytes);
}

void ArchiveReader::FromStream(char* data, std::size_t bytes) {
  in_->read(data, static_cast<std::streamsize>(bytes));
  if (!*in_) Fail("cannot be read to its end");
  in_stream_ -= bytes;
}

}  // namespace splitfusion
