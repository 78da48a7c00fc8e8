#ifndef SPLITFUSION_LIB_REPORT_FRAME_PARTS_H_
#define SPLITFUSION_LIB_REPORT_FRAME_PARTS_H_

#include <array>

#include "splitfusion/lib/report/frame_report.h"

namespace splitfusion {

/// One part of the work on a frame: its name in every report, and where a
/// FrameReport holds its seconds.
struct FramePart {
  const char* name;              ///< Key in the files.
  double FrameReport::*seconds;  ///< Wall clock of the part.
};

/// The parts in the order in which data walks through them.
inline constexpr std::array<FramePart, 8> kFrameParts = {{
    {"read", &FrameReport::read_seconds},
    {"segment", &FrameReport::segment_seconds},
    {"split", &FrameReport::split_seconds},
    {"render", &FrameReport::render_seconds},
    {"associate", &FrameReport::associate_seconds},
    {"solve", &FrameReport::solve_seconds},
    {"fuse", &FrameReport::fuse_seconds},
    {"mesh", &FrameReport::mesh_seconds},
}};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_FRAME_PARTS_H_
