#ifndef SPLITFUSION_LIB_TRACKING_USUAL_MISFIT_H_
#define SPLITFUSION_LIB_TRACKING_USUAL_MISFIT_H_

#include <limits>
#include <optional>

#include "splitfusion/lib/tracking/track_state.h"

namespace splitfusion {

/// How badly the camera's view usually fits the model (SurfaceReport::misfit):
/// what fits worse by far is another scene, or another place.
class UsualMisfit {
 public:
  /// `worse`: what fits as usual has less than so many times the usual misfit.
  explicit UsualMisfit(double worse) : worse_(worse) {}

  /// Of a tracked frame.
  void Add(double misfit) {
    if (!usual_) usual_ = misfit;
    *usual_ += (misfit - *usual_) / kUsualFrames;
  }

  /// Up to which a frame fits as usual; without bound before the first one.
  double Highest() const {
    return usual_ ? worse_ * *usual_ + kLeast
                  : std::numeric_limits<double>::infinity();
  }

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(usual_);
  }

 private:
  /// So much happens where all fits, metres and greys aside.
  static constexpr double kLeast = 0.1;

  double worse_;
  std::optional<double> usual_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_USUAL_MISFIT_H_
