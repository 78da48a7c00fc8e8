#include "splitfusion/lib/base/content_cache.h"

#include <sys/stat.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <map>

#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// By file: its state, and the hash of its content.
using Remembered = std::map<std::string, std::pair<std::string, std::string>>;

/// A file that was changed a moment ago may change again within the resolution
/// of its time, seconds.
constexpr int kSettled = 2;

struct FileState {
  std::string text;      // Size, times of content and of change, inode.
  bool settled = false;  // Whether the text tells of every later change.
};

FileState StateOf(const std::string& path) {
  struct stat state = {};
  if (stat(path.c_str(), &state) != 0 || !S_ISREG(state.st_mode)) {
    throw InputError(path + ": cannot be read; expected a file");
  }
  std::string text = std::to_string(state.st_size);
  // The first can be set back by whoever changes a file, the second cannot.
  for (const timespec& time : {state.st_mtim, state.st_ctim}) {
    text +=
        ' ' + std::to_string(time.tv_sec) + '.' + std::to_string(time.tv_nsec);
  }
  const std::time_t last = std::max(state.st_mtim.tv_sec, state.st_ctim.tv_sec);
  return {text + ' ' + std::to_string(state.st_ino),
          std::time(nullptr) - last > kSettled};
}

Remembered Read(const std::string& path) {
  try {
    return ReadJsonOrNull<Json>(path).get<Remembered>();
  } catch (const Json::exception&) {
    return {};  // None, or a damaged one: everything is read again.
  }
}

void Write(const std::string& path, const Remembered& remembered) {
  try {
    WriteJson(path, Json(remembered));
  } catch (const InputError&) {
    // It costs time only.
  }
}

}  // namespace

std::string ContentCache::HashOfFiles(
    const std::string& root, const std::vector<std::string>& names) const {
  const std::string canonical = fs::weakly_canonical(root).string();
  const std::string file =
      (fs::path(folder_) / (ContentHash().Add(canonical).Hex() + ".json"))
          .string();
  Remembered remembered = folder_.empty() ? Remembered() : Read(file);
  std::vector<FileState> states(names.size());
  std::vector<std::string> hashes(names.size());
  tbb::parallel_for(std::size_t{0}, names.size(), [&](std::size_t i) {
    const std::string path = (fs::path(root) / names[i]).string();
    states[i] = StateOf(path);
    const auto known = remembered.find(names[i]);
    const bool same =
        known != remembered.end() && known->second.first == states[i].text;
    hashes[i] = same ? known->second.second : HashOfFile(path);
  });
  ContentHash hash;
  bool changed = false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    hash.Add(names[i]).Add(hashes[i]);
    if (!states[i].settled) continue;
    auto& entry = remembered[names[i]];
    changed = changed || entry.first != states[i].text;
    entry = {states[i].text, hashes[i]};
  }
  if (changed && !folder_.empty()) Write(file, remembered);
  return hash.Hex();
}

std::string UserCacheFolder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  if (cache != nullptr && *cache != '\0') {
    return (fs::path(cache) / "splitfusion").string();
  }
  if (home == nullptr || *home == '\0') return "";
  return (fs::path(home) / ".cache/splitfusion").string();
}

}  // namespace splitfusion
