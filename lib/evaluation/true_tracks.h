#ifndef SPLITFUSION_LIB_EVALUATION_TRUE_TRACKS_H_
#define SPLITFUSION_LIB_EVALUATION_TRUE_TRACKS_H_

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "splitfusion/lib/evaluation/track_point.h"
#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// True positions of surface points through a sequence.
class TrueTracks {
 public:
  /// Reads `tracks.bin`, little endian: uint32 magic 0x4b525431, version 1,
  /// frames F, points N; N x {int32 instance, int32 triangle, float32 b1, b2};
  /// float32 [F][N][3] world positions; uint8 [F][N] visible.
  ///
  /// @throw InputError on a missing, truncated or foreign file.
  static TrueTracks Read(const std::string& path);

  int frames() const { return frames_; }  ///< Frames of the sequence.
  int points() const { return points_; }  ///< Points; ids are 0..points()-1.
  /// Instance that a point belongs to.
  int Instance(int point) const { return instances_[point]; }
  /// World frame, metres.
  Eigen::Vector3d Position(int frame, int point) const {
    return positions_[At(frame, point)].cast<double>();
  }
  /// Whether the camera sees the point in the frame.
  bool Visible(int frame, int point) const {
    return visible_[At(frame, point)] != 0;
  }
  /// Number of points that the camera sees in a frame.
  int VisibleCount(int frame) const;

  /// The points that the camera sees in `frame`, in its camera frame.
  std::vector<TrackPoint> Queries(int frame,
                                  const Rigid3d& world_from_camera) const;

 private:
  std::size_t At(int frame, int point) const {
    return static_cast<std::size_t>(frame) * points_ + point;
  }

  int frames_ = 0;
  int points_ = 0;
  std::vector<std::int32_t> instances_;
  std::vector<Eigen::Vector3f> positions_;
  std::vector<std::uint8_t> visible_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_TRUE_TRACKS_H_
