#include "splitfusion/lib/evaluation/track_point.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"

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
  std::ifstream stream(path);
  if (!stream) throw InputError(path + ": cannot be opened");
  std::vector<TrackPoint> points;
  std::string line;
  bool head_allowed = true;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.empty() || line[0] == '#' || line == "\r") continue;
    TrackPoint point;
    if (ParseRow(line, &point)) {
      points.push_back(point);
    } else if (!head_allowed) {
      throw InputError(path + ":" + std::to_string(number) +
                       ": expected 'id,frame,x,y,z', found '" + line + "'");
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
      char row[128];
      std::snprintf(row, sizeof(row), "%d,%d,%.6f,%.6f,%.6f\n", point.id,
                    point.frame, point.position.x(), point.position.y(),
                    point.position.z());
      out << row;
    }
  });
}

}  // namespace splitfusion
