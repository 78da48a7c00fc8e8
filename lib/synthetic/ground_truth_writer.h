#ifndef SPLITFUSION_LIB_SYNTHETIC_GROUND_TRUTH_WRITER_H_
#define SPLITFUSION_LIB_SYNTHETIC_GROUND_TRUTH_WRITER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "splitfusion/lib/sequence/trajectory.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"
#include "splitfusion/lib/synthetic/synthetic_writer.h"

namespace splitfusion {

/// Writes the `gt/` folder of a synthetic sequence: poses, labels, static mesh,
/// posed meshes and tracks of surface points. Frames must come in order.
class GroundTruthWriter {
 public:
  /// `directory` is made; `scene` must outlive the writer.
  GroundTruthWriter(const std::string& directory, const SyntheticScene& scene,
                    const SyntheticWriterOptions& options);

  /// Writes the frame's label image and, every mesh_every frames, the posed
  /// meshes; keeps its pose and tracks.
  ///
  /// @throw InputError if a file cannot be written.
  void AddFrame(const SyntheticFrame& frame);

  /// Writes what covers the whole sequence.
  ///
  /// @throw InputError if a file cannot be written.
  void Finish() const;

 private:
  void CountSeenVertices(const SyntheticFrame& frame);
  void WriteStaticMesh() const;
  void WriteLabels() const;
  void WriteTracks() const;
  void WriteConfig() const;

  std::string directory_;
  const SyntheticScene& scene_;
  SyntheticWriterOptions options_;
  Trajectory trajectory_;
  std::vector<double> seen_;            // Per vertex of the static mesh.
  std::vector<float> track_positions_;  // Frame by frame.
  std::vector<std::uint8_t> track_visible_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_GROUND_TRUTH_WRITER_H_
