#ifndef SPLITFUSION_LIB_SEGMENTATION_DETECTION_LIST_H_
#define SPLITFUSION_LIB_SEGMENTATION_DETECTION_LIST_H_

#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace splitfusion {

/// One detection as a mask folder lists it.
struct Detection {
  int index = 0;           ///< Its pixels in the label image, 1..65535.
  std::string class_name;  ///< COCO name, or that of a mask without a class.
  double score = 1;        ///< 0..1.
  cv::Rect2d box = {};     ///< Pixels; empty if none is listed.
  /// File of its whole mask, relative to the folder; empty if no other
  /// detection covers a part of it, so that the label image says it all.
  std::string mask = {};
};

/// Name of the list of all detections in a mask folder.
inline constexpr char kDetectionListFile[] = "detections.jsonl";

/// Reads `STEM.json`: a list of {"index", "class", "score"}.
///
/// `unnamed_class`: class of detections without one.
/// @throw InputError on a broken file or an index that comes twice.
std::vector<Detection> ReadDetections(const std::string& path,
                                      const std::string& unnamed_class);

/// What follows the stem in the name of a list of classes.
inline constexpr char kClassListExtension[] = ".classes.txt";

/// Reads `STEM.classes.txt`: lines "INDEX CLASS", where CLASS is a name or the
/// number of a COCO class, from 1 (person) to 80; `#` begins a comment.
///
/// @throw InputError on a broken line, or an index that comes twice, by the
///     line's number.
std::vector<Detection> ReadClassList(const std::string& path);

/// Detections by the stem of their frame.
using DetectionLists = std::map<std::string, std::vector<Detection>>;

/// Reads `detections.jsonl`, one detection a line: {"stem", "index", "class",
/// "score", "box", "mask"}; box (corners x0, y0, x1, y1) and mask may be
/// missing.
///
/// @throw InputError on a missing file, and on a broken line or an index that
///     comes twice for a stem, by the line's number.
DetectionLists ReadDetectionLists(const std::string& path,
                                  const std::string& unnamed_class);

/// One line of `detections.jsonl`, without its end. `frame`: its index.
std::string DetectionLine(int frame, const std::string& stem,
                          const Detection& detection);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_DETECTION_LIST_H_
