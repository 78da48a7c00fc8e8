#include "splitfusion/lib/base/content_hash.h"

#include <xxhash.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

struct ContentHash::State {
  State() : xxh(XXH3_createState()) { XXH3_128bits_reset(xxh); }
  ~State() { XXH3_freeState(xxh); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  XXH3_state_t* xxh;
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) {}
ContentHash::~ContentHash() = default;
ContentHash::ContentHash(ContentHash&&) noexcept = default;
ContentHash& ContentHash::operator=(ContentHash&&) noexcept = default;

ContentHash& ContentHash::Add(const void* data, std::size_t bytes) {
  XXH3_128bits_update(state_->xxh, data, bytes);
  return *this;
}

ContentHash& ContentHash::Add(const std::string& text) {
  const std::uint64_t size = text.size();
  return Add(&size, sizeof(size)).Add(text.data(), text.size());
}

std::string ContentHash::Hex() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_->xxh);
  char text[33];
  std::snprintf(text, sizeof(text), "%016llx%016llx",
                static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return text;
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
