#ifndef SPLITFUSION_LIB_REPORT_DISK_SPACE_H_
#define SPLITFUSION_LIB_REPORT_DISK_SPACE_H_

#include <cstdint>
#include <string>

namespace splitfusion {

/// What a run writes, as far as it can be told before.
struct RunExtent {
  std::int64_t pixels = 0;  ///< Of an image.
  int frames = 0;           ///< To be read.
  int pictures_every = 0;   ///< Pictures of every n-th frame; 0 = none.
  bool checkpoints = true;  ///< Whether the state is saved.
};

/// About what the run directory takes at least while the run goes on, bytes:
/// volumes and meshes of what one view shows, the state beside them (the more
/// so two states, where one replaces another), and what grows with the frames.
std::uint64_t EstimatedBytes(const RunExtent& extent);

/// @throw InputError if the disk of `folder` has less than `bytes` left.
void CheckDiskSpace(const std::string& folder, std::uint64_t bytes);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_DISK_SPACE_H_
