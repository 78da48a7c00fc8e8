#ifndef SPLITFUSION_LIB_EXPORT_APPEARANCE_H_
#define SPLITFUSION_LIB_EXPORT_APPEARANCE_H_

#include <vector>

#include "splitfusion/lib/export/export_surface.h"

namespace splitfusion {

/// A surface in pieces that appear as they had been seen (SeenTriangles()):
/// in its first frame with anything seen, in those whose index is a multiple of
/// `step`, and in the last one. What was seen in between appears at the next of
/// these. Pieces have the vertices and nodes that they need, and end with the
/// surface; the later ones are called `NAME_from_FRAME`. One that is whole from
/// the start stays as it is.
std::vector<ExportSurface> SplitByAppearance(const ExportSurface& surface,
                                             int step);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_APPEARANCE_H_
