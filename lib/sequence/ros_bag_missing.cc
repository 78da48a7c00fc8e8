// In place of ros_bag.cc in a build without librosbag-storage.
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/ros_bag.h"

namespace splitfusion {

std::unique_ptr<RosBag> OpenRosBag(const std::string& path) {
  throw InputError(path +
                   ": built without librosbag-storage: install "
                   "librosbag-storage-dev and libsensor-msgs-dev and build "
                   "again, or convert it with sf_convert where that is done");
}

}  // namespace splitfusion
