#ifndef SPLITFUSION_LIB_SEQUENCE_OPEN_FILES_H_
#define SPLITFUSION_LIB_SEQUENCE_OPEN_FILES_H_

#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace splitfusion {

/// Files of one kind that have been opened, by their paths. Thread-safe.
template <typename File>
class OpenFiles {
 public:
  /// The file at `path`, made from that if it was not yet; throws as that does.
  std::shared_ptr<const File> At(const std::string& path) {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::shared_ptr<const File>& file = files_[path];
    if (!file) file = std::make_shared<const File>(path);
    return file;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const File>> files_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_OPEN_FILES_H_
