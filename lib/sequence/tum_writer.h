#ifndef SPLITFUSION_LIB_SEQUENCE_TUM_WRITER_H_
#define SPLITFUSION_LIB_SEQUENCE_TUM_WRITER_H_

#include <opencv2/core.hpp>
#include <set>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/sequence/trajectory.h"

namespace splitfusion {

/// Writes a sequence in the layout of the TUM RGB-D benchmark: `rgb/`, `depth/`
/// (16 bit, 5000 units a metre, so that what is farther than 13 m is left out),
/// their lists, `associations.txt`, `camera.txt`, `groundtruth.txt`.
class TumWriter {
 public:
  /// `folder` is made with the first frame.
  explicit TumWriter(const std::string& folder) : folder_(folder) {}

  /// Writes a frame, later than all before. `stem`: name of its files. `color`:
  /// HxW 8UC3, BGR. `depth`: HxW, metres, 0 = none, registered to it.
  ///
  /// @throw InputError if a file cannot be written, or a name comes again.
  void Add(const std::string& stem, double timestamp, const cv::Mat& color,
           const cv::Mat_<float>& depth);

  /// Writes the lists, and the poses if there are any.
  ///
  /// @throw InputError if a file cannot be written.
  void Finish(const PinholeCamera& camera, const Trajectory& poses) const;

 private:
  struct Entry {
    std::string time;  // As text.
    std::string stem;
  };
  void WriteList(const std::string& kind, const std::string& title) const;

  std::string folder_;
  std::vector<Entry> entries_;
  std::set<std::string> stems_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_TUM_WRITER_H_
