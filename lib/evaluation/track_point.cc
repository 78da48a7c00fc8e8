#include "splitfusion/lib/evaluation/track_point.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <sstream>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/text_file.h"

namespace splitfusion {
namespace {

bool ParseRow(std::string line, TrackPoint* point) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream words(line);
  Eigen::Vector3d& p = point->position;
  return (words >> point->id >> point->frame >> p.x() >> p.y() >> p.z()) &&
         p.allFinite();
}

}  // namespace

std::vector<TrackPoint> ReadTrackPoints(const std::string& path) {
  std::vector<TrackPoint> points;
  bool head_allowed = true;
  for (const TextLine& line : ReadTextLines(path)) {
    TrackPoint point;
    if (ParseRow(line.text, &point)) {
      points.push_back(point);
    } else if (!head_allowed) {
      throw InputError(line.place + ": expected 'id,frame,x,y,z', found '" +
                       line.text + "'");
    }
    head_allowed = false;
  }
  if (points.empty()) {
    throw InputError(path + ": no row: expected rows 'id,frame,x,y,z'");
  }
  return points;
}

void WriteTrackPoints(const std::string& path,
                      const std::vector<TrackPoint>& points) {
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << "id,frame,x,y,z\n";
    for (const TrackPoint& point : points) {
      const Eigen::Vector3d& p = point.position;
      out << cv::format("%d,%d,%.6f,%.6f,%.6f\n", point.id, point.frame, p.x(),
                        p.y(), p.z());
    }
  });
}

}  // namespace splitfusion
