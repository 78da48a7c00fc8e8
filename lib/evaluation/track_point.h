#ifndef SPLITFUSION_LIB_EVALUATION_TRACK_POINT_H_
#define SPLITFUSION_LIB_EVALUATION_TRACK_POINT_H_

#include <Eigen/Core>
#include <string>
#include <vector>

namespace splitfusion {

/// Where a followed point is in a frame.
struct TrackPoint {
  int id = 0;     ///< Of the point; the same in all frames.
  int frame = 0;  ///< Frame index.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< Camera frame, m.
};

/// Reads CSV rows `id,frame,x,y,z` (camera frame, metres); further columns,
/// lines that begin with # and a head line are ignored.
///
/// @throw InputError on a missing file, a line that does not parse (names it)
///     or a file without points.
std::vector<TrackPoint> ReadTrackPoints(const std::string& path);

/// Writes such a file with the head line `id,frame,x,y,z`, six decimals.
///
/// @throw InputError if the file cannot be written.
void WriteTrackPoints(const std::string& path,
                      const std::vector<TrackPoint>& points);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_TRACK_POINT_H_
