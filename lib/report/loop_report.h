#ifndef SPLITFUSION_LIB_REPORT_LOOP_REPORT_H_
#define SPLITFUSION_LIB_REPORT_LOOP_REPORT_H_

namespace splitfusion {

/// What became of the camera's path at the end of a run.
struct LoopReport {
  int key_frames = 0;         ///< On the path.
  int compared = 0;           ///< Pairs of them that were compared.
  int found = 0;              ///< On whose motion enough landmarks agree.
  int kept = 0;               ///< With which the solution agrees.
  double misfit_before = 0;   ///< RMS of kept ones, metres.
  double misfit_after = 0;    ///< Likewise, with the poses as they stay.
  double largest_change = 0;  ///< Of what a key frame shows, RMS, metres.
  double largest_shift = 0;   ///< Of a key frame's camera, metres.
  double largest_turn = 0;    ///< Likewise, radians.
  double largest_drift = 0;   ///< By which a kept one contradicted, metres.
  bool fused_anew = false;    ///< Whether the results are of these poses.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(key_frames, compared, found, kept, misfit_before, misfit_after,
               largest_change, largest_shift, largest_turn, largest_drift,
               fused_anew);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_LOOP_REPORT_H_
