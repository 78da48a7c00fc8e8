#ifndef SPLITFUSION_LIB_SEQUENCE_ASSOCIATION_LIST_H_
#define SPLITFUSION_LIB_SEQUENCE_ASSOCIATION_LIST_H_

#include <string>
#include <vector>

namespace splitfusion {

/// One line of `rgb.txt` or `depth.txt`.
struct TimedFile {
  double timestamp = 0;  ///< Seconds.
  std::string file;      ///< Relative to the sequence's folder.
};

/// Colour and depth image of one frame.
struct AssociatedFiles {
  TimedFile color;  ///< Colour image.
  TimedFile depth;  ///< Depth image.
};

/// Reads a TUM list: `timestamp file`, `#` comments.
///
/// @throw InputError on a missing file or a line that does not parse.
std::vector<TimedFile> ReadTimedFiles(const std::string& path);

/// Reads `associations.txt` of a sequence: `t file t file`, colour and depth
/// in either order. Which column is the depth shows in the file names (a
/// folder or name with "depth"), or else in the first pair of images.
///
/// @throw InputError on a missing file or a line that does not parse.
std::vector<AssociatedFiles> ReadAssociations(const std::string& folder);

/// Pairs by nearest time stamp, one to one, closest pairs first (the rule of
/// the TUM tools), in order of the depth time stamp.
///
/// `tolerance`: largest difference, seconds.
std::vector<AssociatedFiles> AssociateByTime(
    const std::vector<TimedFile>& color, const std::vector<TimedFile>& depth,
    double tolerance);

/// `associations.txt` of a sequence if it has one, else AssociateByTime() of
/// its `rgb.txt` and `depth.txt`.
///
/// @throw InputError if neither is there or no pair is found.
std::vector<AssociatedFiles> FindAssociations(const std::string& folder,
                                              double tolerance);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_ASSOCIATION_LIST_H_
