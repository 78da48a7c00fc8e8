#ifndef SPLITFUSION_TESTS_SUPPORT_SAMPLE_MESHES_H_
#define SPLITFUSION_TESTS_SUPPORT_SAMPLE_MESHES_H_

#include <functional>

#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// A mesh over the rectangle [0, width] x [0, height] with vertices every
/// `step` (metres), placed by `place`; counter-clockwise as seen from -z where
/// `place` keeps the orientation.
TriangleMesh SheetMesh(
    double width, double height, double step,
    const std::function<Eigen::Vector3d(double x, double y)>& place);

/// A flat plate of that size at z-depth `z`, facing the camera.
TriangleMesh PlateMesh(double width, double height, double step, double z);

/// A strip folded like a hairpin, an arm beside a torso: two plates of `length`
/// x `height`, at z = 1 and z = 1 + gap, joined by a half circle at x >=
/// length. Arc length along the strip is the sheet's x.
TriangleMesh HairpinMesh(double length, double height, double gap, double step);

/// Appends the vertices and triangles of `more`.
void AppendMesh(const TriangleMesh& more, TriangleMesh* mesh);

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_SAMPLE_MESHES_H_
