#ifndef SPLITFUSION_LIB_EVALUATION_SEEN_SCORE_H_
#define SPLITFUSION_LIB_EVALUATION_SEEN_SCORE_H_

#include <map>
#include <string>
#include <vector>

#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/evaluation/live_images.h"
#include "splitfusion/lib/evaluation/true_occasion.h"

namespace splitfusion {

/// Distance at which the model counts as right, metres.
constexpr double kSeenThreshold = 0.02;

/// How right and how complete a model is within kSeenThreshold.
struct SeenFrame {
  int frame = 0;         ///< Frame index.
  double precision = 0;  ///< Part of the model's area that is on the truth.
  double recall = 0;     ///< Part of the seen truth's area with model.
  double f_score = 0;    ///< Harmonic mean.
};

/// SeenFrame of one instance over a run.
struct SeenScore {
  int surface_id = -1;  ///< The surface with the greatest mean F-score; -1 =
                        ///< no surface lies on the instance.
  std::vector<SeenFrame> frames;  ///< All that count; 0 without a model.

  /// Means over the frames; `frame` is -1. Zero without frames.
  SeenFrame Mean() const;
};

/// Compares the models with what a camera has shown of every instance so far:
/// the best a perfect tracker could do has a score of 1.
///
/// A vertex of the true mesh is seen by a frame if in that frame or an earlier
/// one, among those that have a true mesh, it projected within two pixels of a
/// live pixel of its label whose depth is within 3 cm of its own. Precision is
/// that of the model against the whole true mesh, recall that of the seen part
/// of the true mesh (a triangle counts by the part of its corners that are
/// seen) against the model. Frames count from the first true mesh on at which
/// the instance has more than `plain_view_pixels` live pixels; one without a
/// model of the surface counts 0. The model is put into the world with the true
/// pose, so that errors of the camera do not count. Distances are those between
/// 30,000 random points on each surface, so a score is about 0.01 smaller than
/// with exact ones.
///
/// `label_folder`: label/ of the ground truth; occasions without a label image
/// are left out.
/// @return by instance; those without a frame that counts have none.
/// @throw InputError if an image is missing or broken.
std::map<int, SeenScore> ScoreSeen(const std::vector<AnimatedSurface>& surfaces,
                                   const std::vector<TrueOccasion>& occasions,
                                   const LiveImages& live,
                                   const std::string& label_folder,
                                   int plain_view_pixels);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_SEEN_SCORE_H_
