#ifndef SPLITFUSION_LIB_BASE_CONTENT_CACHE_H_
#define SPLITFUSION_LIB_BASE_CONTENT_CACHE_H_

#include <string>
#include <vector>

namespace splitfusion {

/// Hashes of files by content that remembers what it has read: a file whose
/// size, times of content and of change, and inode are as before is not read
/// again.
class ContentCache {
 public:
  /// `folder`: where it is kept, made when needed; empty = nowhere. What cannot
  /// be read or written there is no error.
  explicit ContentCache(std::string folder) : folder_(std::move(folder)) {}

  /// Hash of the names and contents of files, in their order, 32 hexadecimal
  /// digits. `names` are relative to `root`.
  ///
  /// @throw InputError if a file cannot be read.
  std::string HashOfFiles(const std::string& root,
                          const std::vector<std::string>& names) const;

 private:
  std::string folder_;
};

/// $XDG_CACHE_HOME/splitfusion, or else $HOME/.cache/splitfusion; empty if
/// neither is set.
std::string UserCacheFolder();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_CONTENT_CACHE_H_
