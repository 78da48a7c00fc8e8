#include "splitfusion/lib/base/content_hash.h"

#include <xxhash.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

namespace {

using HashState = std::unique_ptr<XXH3_state_s, void (*)(XXH3_state_s*)>;

HashState NewHashState() {
  return {XXH3_createState(),
          [](XXH3_state_s* state) { XXH3_freeState(state); }};
}

}  // namespace

ContentHash::ContentHash() : state_(NewHashState()) {
  XXH3_128bits_reset(state_.get());
}

ContentHash& ContentHash::Add(const void* data, std::size_t bytes) {
  XXH3_128bits_update(state_.get(), data, bytes);
  return *this;
}

ContentHash& ContentHash::Add(const std::string& text) {
  const std::uint64_t size = text.size();
  return Add(&size, sizeof(size)).Add(text.data(), text.size());
}

std::string ContentHash::Hex() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
  return cv::format("%016lx%016lx", hash.high64, hash.low64);
}

RunningChecksum64::RunningChecksum64() : state_(NewHashState()) {
  XXH3_64bits_reset(state_.get());
}

void RunningChecksum64::Add(const void* data, std::size_t bytes) {
  XXH3_64bits_update(state_.get(), data, bytes);
}

std::uint64_t RunningChecksum64::Value() const {
  return XXH3_64bits_digest(state_.get());
}

std::uint64_t Checksum64(const void* data, std::size_t bytes) {
  return XXH3_64bits(data, bytes);
}

std::string HashOfFile(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || !std::filesystem::is_regular_file(path)) {
    throw InputError(path + ": cannot be read; expected a file");
  }
  std::vector<char> buffer(1 << 20);
  ContentHash hash;
  while (stream) {
    stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    hash.Add(buffer.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw InputError(path + ": cannot be read to its end");
  return hash.Hex();
}

}  // namespace splitfusion
