#include "splitfusion/lib/sequence/color_camera.h"

#include <cmath>
#include <iomanip>
#include <sstream>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/text_file.h"
#include "splitfusion/lib/geometry/focal_length.h"

namespace splitfusion {

/// Metres.
constexpr double kFarthest = 1;  // Format: one device has both.

ColorCamera ColorCamera::Registered(const PinholeCamera& depth_camera) {
  ColorCamera color;
  color.fx = depth_camera.fx;
  color.fy = depth_camera.fy;
  color.cx = depth_camera.cx;
  color.cy = depth_camera.cy;
  return color;
}

void ColorCamera::Check() const {
  CheckFocalLength("fx of the colour camera", fx);
  CheckFocalLength("fy of the colour camera", fy);
  CheckOption(std::isfinite(cx), "cx of the colour camera", cx, "pixels");
  CheckOption(std::isfinite(cy), "cy of the colour camera", cy, "pixels");
  CheckOption((width > 0) == (height > 0) && width >= 0 && height >= 0,
              "size of the colour camera",
              std::to_string(width) + "x" + std::to_string(height),
              "two positive numbers of pixels, or none");
  CheckOption(color_from_depth.matrix().allFinite(),
              "pose of the colour camera", "nan", "finite numbers");
  const double way = color_from_depth.translation().norm();
  CheckOption(way <= kFarthest, "way to the colour camera", way,
              "1 m at most from the depth camera");
  CheckOption(color_from_depth.linear()(2, 2) > 0, "view of the colour camera",
              color_from_depth.linear()(2, 2),
              "one ahead as the depth camera's");
}

ColorCamera ReadColorCamera(const std::string& path) {
  const std::string expected =
      "'fx fy cx cy tx ty tz qx qy qz qw', or with 'width height' after it";
  const std::vector<TextLine> lines =
      ReadTextLines(path, /*cut_comments=*/true);
  if (lines.empty()) throw InputError(path + ": no line: expected " + expected);
  ColorCamera camera;
  Eigen::Vector3d t;
  Eigen::Quaterniond q;
  std::istringstream words(lines[0].text);
  if (!(words >> camera.fx >> camera.fy >> camera.cx >> camera.cy >> t.x() >>
        t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w())) {
    lines[0].Refuse(expected);
  }
  if (!(words >> std::ws).eof() && (!(words >> camera.width >> camera.height) ||
                                    !(words >> std::ws).eof())) {
    lines[0].Refuse(expected);
  }
  if (lines.size() > 1) lines[1].Refuse("one line " + expected);
  camera.color_from_depth.linear() = q.normalized().toRotationMatrix();
  camera.color_from_depth.translation() = t;
  try {
    CheckOption(q.norm() > 0, "quaternion of the colour camera", q.norm(),
                "one that is not 0");
    camera.Check();
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
  return camera;
}

std::string ToText(const ColorCamera& camera) {
  const Eigen::Vector3d t = camera.color_from_depth.translation();
  const Eigen::Quaterniond q(camera.color_from_depth.linear());
  std::ostringstream text;
  text << std::setprecision(17) << camera.fx << ' ' << camera.fy << ' '
       << camera.cx << ' ' << camera.cy << ' ' << t.x() << ' ' << t.y() << ' '
       << t.z() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << q.w();
  if (camera.width > 0) text << ' ' << camera.width << ' ' << camera.height;
  return text.str();
}

void WriteColorCamera(const std::string& path, const ColorCamera& camera) {
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << "# colour camera: fx fy cx cy (pixels), then colour from depth: tx "
           "ty tz (metres) qx qy qz qw, then the size if it is not that of "
           "the depth\n"
        << ToText(camera) << '\n';
  });
}

}  // namespace splitfusion
