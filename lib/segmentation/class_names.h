#ifndef SPLITFUSION_LIB_SEGMENTATION_CLASS_NAMES_H_
#define SPLITFUSION_LIB_SEGMENTATION_CLASS_NAMES_H_

#include <string>
#include <vector>

namespace splitfusion {

/// The 80 classes of COCO in the order of the networks trained on it, without
/// background: 0 is "person", 77 "teddy bear".
const std::vector<std::string>& CocoClassNames();

/// Class names of a network from a text file, one a line in the order of the
/// network's classes, without background; blank lines are left out.
///
/// @throw InputError on a missing file or one without a name.
std::vector<std::string> ReadClassNames(const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_CLASS_NAMES_H_
