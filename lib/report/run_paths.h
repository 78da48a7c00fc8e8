#ifndef SPLITFUSION_LIB_REPORT_RUN_PATHS_H_
#define SPLITFUSION_LIB_REPORT_RUN_PATHS_H_

#include <string>

namespace splitfusion {

/// Names of everything in a run directory; the one place that spells them.
/// FRAME is the frame index in six digits, surfaces are `NNN_LABEL`.
class RunPaths {
 public:
  /// Paths below the run directory `root`; nothing is touched on disk.
  explicit RunPaths(std::string root);

  /// The run directory itself.
  const std::string& root() const { return root_; }
  std::string Marker() const;      ///< RUN/run.json
  std::string Lock() const;        ///< RUN/lock
  std::string Unfinished() const;  ///< RUN/unfinished, of a run that goes on
  std::string Checkpoint() const;  ///< RUN/checkpoint.bin
  /// RUN/checkpoints/FRAME.bin, state before that frame.
  std::string KeptCheckpoint(int frame) const {
    return Below("checkpoints/" + FrameName(frame) + ".bin");
  }
  std::string Options() const;      ///< RUN/options.flags
  std::string Calibration() const;  ///< RUN/calibration.txt
  std::string ColorCamera() const;  ///< RUN/color_camera.txt
  std::string Trajectory() const;   ///< RUN/trajectory.txt
  std::string Frames() const;       ///< RUN/frames.jsonl
  std::string Iterations() const;   ///< RUN/iterations.csv
  std::string Refinement() const;   ///< RUN/refinement.jsonl
  /// RUN/hidden_deviations.csv
  std::string HiddenDeviations() const;
  std::string Summary() const;     ///< RUN/summary.json
  std::string Evaluation() const;  ///< RUN/evaluation.json
  std::string HtmlReport() const;  ///< RUN/report.html
  std::string Pictures() const;    ///< RUN/pictures
  /// RUN/detections, the masks of a network that ran inline.
  std::string Detections() const;
  /// RUN/problems/FRAME_NNN.h5, the last solve of surface NNN in a frame; or
  /// FRAME_NNN_first.h5, the first one of more than one node.
  std::string Problem(int frame, int surface, bool first) const;
  /// Frozen window of hidden motions that begins in a frame, of a part of a
  /// surface.
  std::string HiddenProblem(int frame, int surface, int part) const;
  /// RUN/uncertainty/FRAME_NNN.ply, surface NNN in a frame.
  std::string Uncertainty(int frame, int surface) const;
  /// RUN/solver/FRAME.txt
  std::string SolverReport(int frame) const {
    return Below("solver/" + FrameName(frame) + ".txt");
  }
  /// RUN/pictures/FRAME_name.png
  std::string Picture(int frame, const std::string& name) const {
    return Below("pictures/" + FrameName(frame) + "_" + name + ".png");
  }
  /// RUN/masks/STEM.png, 16-bit surface ids; `stem` of the depth file.
  std::string Mask(const std::string& stem) const {
    return Below("masks/" + stem + ".png");
  }
  /// RUN/surfaces/NNN_LABEL; characters of the label other than letters,
  /// digits, hyphens and dots become underscores, and the name ends after 64
  /// characters.
  std::string Surface(int id, const std::string& label) const;
  /// RUN/surfaces/NNN_LABEL/residuals.h5
  std::string Residuals(int id, const std::string& label) const {
    return Surface(id, label) + "/residuals.h5";
  }
  /// RUN/surfaces/NNN_LABEL/warped/FRAME.ply
  std::string WarpedMesh(int id, const std::string& label, int frame) const;

  /// Whether a run writes a file or folder of this name into its directory.
  static bool IsOfRun(const std::string& name);

  /// Folder name of a surface, `NNN_LABEL`.
  static std::string SurfaceName(int id, const std::string& label);
  /// Frame index in six digits.
  static std::string FrameName(int frame);

 private:
  std::string Below(const std::string& name) const;

  std::string root_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_RUN_PATHS_H_
