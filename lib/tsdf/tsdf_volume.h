#ifndef SPLITFUSION_LIB_TSDF_TSDF_VOLUME_H_
#define SPLITFUSION_LIB_TSDF_TSDF_VOLUME_H_

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/tsdf/pixel_role.h"

namespace splitfusion {

/// Resolution of a volume.
struct TsdfOptions {
  double voxel_size = 0.01;  ///< Metres.
  double truncation = 0.04;  ///< Metres; at least 2 voxels.
  double max_weight = 64;    ///< Cap of the running mean's weight.
  /// Voxels are written so many standard deviations of the depth noise behind
  /// a measurement, if that is more than the truncation: else the part of the
  /// noise that is cut off there moves a surface away. Of thin things, which
  /// are seen from behind, too, it would reach the other side.
  double reach_sigmas = 0;
  /// Blocks for which fewer pixels of a frame ask (every other one of every
  /// other row) are not made: noise, which would ask for ever more of them.
  int min_block_pixels = 2;
  /// False: distances alone. Takes two thirds of the memory; meshes are black.
  bool has_color = true;

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
  /// @throw OptionError if a value is out of its range.
  void Check() const;
};

/// One depth image, as a volume sees it; all images HxW of the camera.
struct DepthObservation {
  /// Intrinsics of all images.
  PinholeCamera camera;
  cv::Mat_<float> depth;        ///< Metres, 0 = none.
  cv::Mat_<float> weight;       ///< Confidence of every pixel, about 0..1.
  cv::Mat_<std::uint8_t> role;  ///< PixelRole of every pixel.
  cv::Mat color;                ///< 8UC3, BGR; may be empty for a volume
                                ///< without colour.
  /// Where in the canonical frame a pixel's point belongs, metres, NaN where
  /// that is not known; empty: of none. What is farther than `place_tolerance`
  /// (metres) from there is not written, only carved. Of warped surfaces.
  cv::Mat_<cv::Vec3f> places;
  double place_tolerance = 0;  ///< See `places`.
  /// Whether pixels that only carve take their weight from voxels within the
  /// truncation from them, too: what was fused there before another surface was
  /// told apart, or while a detector was wrong, is forgotten in as many frames
  /// as it was seen in.
  bool others_refute = false;
};

/// Truncated signed distance of one surface in its canonical frame, with
/// weight and colour, in OpenVDB grids (SplitFusion IV-D). Distances are
/// positive in front of the surface, in metres. Colours have ten bits a channel
/// in memory.
class TsdfVolume {
 public:
  /// An empty volume. @throw InputError if an option is out of range.
  explicit TsdfVolume(const TsdfOptions& options);
  ~TsdfVolume();
  /// Takes the grids over.
  TsdfVolume(TsdfVolume&&) noexcept;
  /// Takes the grids over.
  TsdfVolume& operator=(TsdfVolume&&) noexcept;

  /// Opaque grids; defined where OpenVDB is.
  struct Grids;

  /// Resolution and caps.
  const TsdfOptions& options() const { return options_; }
  /// The OpenVDB grids.
  const Grids& grids() const { return *grids_; }
  /// The OpenVDB grids, to be changed.
  Grids& grids() { return *grids_; }

  /// Number of 8x8x8 blocks in memory.
  std::size_t leaf_count() const;

  /// Writes grids "distance" (m), "weight" and, if there is colour, "color"
  /// (RGB, 0..1) to a `.vdb` file through a temporary name.
  ///
  /// @throw InputError if the file cannot be written.
  void Write(const std::string& path) const;

  /// Reads what Write wrote. In files of others, voxels without a weight, or
  /// with numbers that are not finite, count as never observed.
  ///
  /// @throw InputError on a missing, truncated or foreign file.
  static TsdfVolume Read(const std::string& path);

  /// Saves or restores all voxels and what fusion knows of their blocks, bit
  /// for bit, see lib/base/archive.h.
  ///
  /// @throw InputError if what is read has other voxels than options().
  template <typename Archive>
  void Serialize(Archive* archive);

 private:
  TsdfOptions options_;
  std::unique_ptr<Grids> grids_;
};

/// Allocates the blocks within the truncation band of the writing pixels, see
/// TsdfOptions::min_block_pixels, for a surface whose canonical frame is carried
/// rigidly.
///
/// @throw InputError if an image is missing or of a wrong size.
void AllocateBand(const DepthObservation& observation,
                  const Rigid3d& camera_from_canonical, TsdfVolume* volume);

/// Allocates the blocks within `radius` (metres) of the given canonical points.
void AllocateAround(const std::vector<Eigen::Vector3d>& points, double radius,
                    TsdfVolume* volume);

/// Fuses one observation into the allocated blocks of a rigid surface, block by
/// block in parallel: projective distance, running weighted mean, free-space
/// carving. Kinect Fusion's update, SplitFusion IV-D.
///
/// @throw InputError if an image is missing or of a wrong size.
void IntegrateRigid(const DepthObservation& observation,
                    const Rigid3d& camera_from_canonical, TsdfVolume* volume);

/// Triangle mesh of the zero level with normals and colours, canonical frame.
/// Only where all voxels around a vertex were observed with at least
/// `min_weight`. Triangles are counter-clockwise seen from outside.
TriangleMesh ExtractMesh(const TsdfVolume& volume, double min_weight);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_TSDF_VOLUME_H_
