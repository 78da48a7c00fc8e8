#ifndef SPLITFUSION_LIB_BASE_CONTENT_HASH_H_
#define SPLITFUSION_LIB_BASE_CONTENT_HASH_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

struct XXH3_state_s;  // Of xxhash.h.

namespace splitfusion {

/// Hash of bytes that are given piece by piece: XXH3 with 128 bits. It finds
/// damage and differences; it is no protection against forgery.
class ContentHash {
 public:
  /// Of nothing so far.
  ContentHash();

  /// Appends bytes.
  ContentHash& Add(const void* data, std::size_t bytes);
  /// Appends a text and its length, so that "ab", "c" is not "a", "bc".
  ContentHash& Add(const std::string& text);

  /// Of all that was added, 32 hexadecimal digits.
  std::string Hex() const;

 private:
  std::unique_ptr<XXH3_state_s, void (*)(XXH3_state_s*)> state_;
};

/// XXH3 with 64 bits, for the checksums within binary files, of bytes that are
/// given piece by piece.
class RunningChecksum64 {
 public:
  /// Of nothing so far.
  RunningChecksum64();

  /// Appends bytes.
  void Add(const void* data, std::size_t bytes);

  /// Of all that was added.
  std::uint64_t Value() const;

 private:
  std::unique_ptr<XXH3_state_s, void (*)(XXH3_state_s*)> state_;
};

/// The same of bytes that are all there.
std::uint64_t Checksum64(const void* data, std::size_t bytes);

/// Hash of a file's content, as ContentHash::Hex().
///
/// @throw InputError if the file cannot be read.
std::string HashOfFile(const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_CONTENT_HASH_H_
