#ifndef SPLITFUSION_LIB_BASE_SPOOLED_LIST_H_
#define SPLITFUSION_LIB_BASE_SPOOLED_LIST_H_

#include <cstdint>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/base/spool_file.h"

namespace splitfusion {

/// Values that are seldom asked for, or not before the end, and would fill the
/// memory: they lie in a temporary file. `T`: what an archive takes, see
/// lib/base/archive.h.
template <typename T>
class SpooledList {
 public:
  /// `file`: where they go.
  explicit SpooledList(
      std::shared_ptr<SpoolFile> file = std::make_shared<SpoolFile>())
      : file_(std::move(file)) {}

  /// Their number.
  int size() const { return static_cast<int>(places_.size()); }

  /// Takes one more.
  ///
  /// @throw InputError if the file cannot be written.
  void Add(const T& value) {
    std::ostringstream stream;
    ArchiveWriter archive(&stream);
    archive(value);
    archive.Flush();
    const std::string bytes = stream.str();
    places_.push_back(
        {file_->Append(bytes.data(), bytes.size()), bytes.size()});
  }

  /// The value i, 0..size() - 1. `value`: what it is read into, which has
  /// already what Serialize() of it leaves out.
  ///
  /// @throw InputError if the file cannot be read.
  T At(int i, T value = T()) const {
    std::string bytes(places_[i].bytes, '\0');
    file_->Read(places_[i].offset, bytes.data(), bytes.size());
    std::istringstream stream(std::move(bytes));
    ArchiveReader archive(&stream, places_[i].bytes, "temporary file");
    archive(value);
    return value;
  }

  /// Saves or restores them, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    const std::uint64_t count = archive->Count(places_.size(), 1);
    if constexpr (Archive::kReads) places_.clear();
    for (std::uint64_t i = 0; i < count; ++i) {
      T value;
      if constexpr (!Archive::kReads) value = At(static_cast<int>(i));
      (*archive)(value);
      if constexpr (Archive::kReads) Add(value);
    }
  }

 private:
  /// Where a value is in the file.
  struct Place {
    std::uint64_t offset = 0;  ///< Of its first byte.
    std::uint64_t bytes = 0;   ///< Its length.
  };

  std::shared_ptr<SpoolFile> file_;
  std::vector<Place> places_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_SPOOLED_LIST_H_
