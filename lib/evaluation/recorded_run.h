#ifndef SPLITFUSION_LIB_EVALUATION_RECORDED_RUN_H_
#define SPLITFUSION_LIB_EVALUATION_RECORDED_RUN_H_

#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/motion_history.h"
#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/sequence/reader_options.h"
#include "splitfusion/lib/sequence/sequence_format.h"
#include "splitfusion/lib/sequence/trajectory.h"

namespace splitfusion {

/// One surface as a run left it.
struct RecordedSurface {
  int id = 0;                   ///< 0 is the background.
  std::string label;            ///< Of the folder name, NNN_LABEL.
  TriangleMesh mesh;            ///< Canonical frame, metres.
  DeformationGraph graph;       ///< Its motions are identity.
  int neighbors_per_point = 0;  ///< K of Eq. 3.
  MotionHistory motions;        ///< Camera from canonical, by frame.
};

/// One frame of a run.
struct RecordedFrame {
  int index = 0;     ///< Frame index.
  TimedPose pose;    ///< Time stamp, and world from camera as estimated.
  std::string stem;  ///< Depth file's name; empty if the run does not say.
};

/// What a run directory holds, as far as evaluation needs it.
struct RecordedRun {
  std::string root;                       ///< The run directory.
  std::vector<RecordedFrame> frames;      ///< By index.
  std::vector<RecordedSurface> surfaces;  ///< By id.
  /// Intrinsics of the live camera: of `calibration.txt` or `camera.txt` in
  /// the run directory, or else beside the sequence that options.flags names
  /// (unless it has --intrinsics too).
  std::optional<PinholeCamera> camera;
  /// Folder of the sequence, of options.flags; empty if that does not say.
  std::string sequence;
  /// How the run read the depth images of the sequence: depth scale of
  /// `calibration.txt` or `camera.txt` in the run directory, or else of
  /// options.flags; range and format of options.flags; the camera as above.
  ReaderOptions reading;
  /// What the format may be.
  FormatRegistry formats = BuiltinFormats();

  /// The frame of an index; null if the run has none.
  const RecordedFrame* Find(int frame) const;

  /// Poses of all frames.
  Trajectory EstimatedTrajectory() const;
};

/// Reads trajectory.txt, frames.jsonl (may be missing: then the rows of the
/// trajectory are the frames), options.flags (may be missing) and surfaces/.
///
/// @throw InputError if something is missing, broken or contradictory.
RecordedRun ReadRun(const std::string& root);

/// Reads one folder NNN_LABEL of surfaces/.
///
/// @throw InputError if a file is missing or the files do not fit together.
RecordedSurface ReadRecordedSurface(const std::string& folder);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_RECORDED_RUN_H_
