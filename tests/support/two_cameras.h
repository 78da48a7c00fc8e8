#ifndef SPLITFUSION_TESTS_SUPPORT_TWO_CAMERAS_H_
#define SPLITFUSION_TESTS_SUPPORT_TWO_CAMERAS_H_

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/sequence/color_camera.h"
#include "splitfusion/lib/sequence/frame.h"

namespace splitfusion {

/// A depth camera of 320x240 pixels.
PinholeCamera BoardsCamera();

/// A colour camera as in a Kinect whose images are not registered: 25 mm beside
/// the depth camera, a focal length of nine tenths, turned by one degree.
ColorCamera BoardsColorCamera();

/// Grey boards at distances of 0.8 to 1.9 m before a wall at 2.5 m, all
/// parallel to the images, others in every frame; seen by both cameras, without
/// noise.
Frame BoardsFrame(int index, const PinholeCamera& depth_camera,
                  const ColorCamera& color_camera);

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_TWO_CAMERAS_H_
