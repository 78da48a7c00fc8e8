#ifndef SPLITFUSION_LIB_SEQUENCE_INTERNAL_ROS_BAG_CHECK_H_
#define SPLITFUSION_LIB_SEQUENCE_INTERNAL_ROS_BAG_CHECK_H_

#include <string>

namespace splitfusion {

/// Looks whether all lengths and offsets in a bag lie within it. librosbag
/// believes them: a wrong offset in an index makes it read memory that is none,
/// a wrong length take gigabytes.
///
/// @throw InputError if they do not, or if it is missing, of another version,
///     encrypted or has no index.
void CheckRosBag(const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_INTERNAL_ROS_BAG_CHECK_H_
