#ifndef SPLITFUSION_LIB_SPLIT_SURFACE_SPLITTER_H_
#define SPLITFUSION_LIB_SPLIT_SURFACE_SPLITTER_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/segmentation/label_table.h"
#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/sequence/frame.h"
#include "splitfusion/lib/split/assignment.h"
#include "splitfusion/lib/split/moving_objects.h"
#include "splitfusion/lib/split/segment.h"
#include "splitfusion/lib/split/split_options.h"
#include "splitfusion/lib/split/split_result.h"
#include "splitfusion/lib/split/surface_prediction.h"
#include "splitfusion/lib/split/tentative_tracks.h"
#include "splitfusion/lib/split/track_table.h"

namespace splitfusion {

/// Splits a frame into surfaces that keep their ids over time (SplitFusion
/// IV-A): assigns the detections to the tracks, refines their masks by a 3D
/// graph cut, and carries surfaces through missed detections with the projected
/// surface as prior.
class SurfaceSplitter {
 public:
  /// @throw InputError if the camera or an option is out of its range.
  SurfaceSplitter(const PinholeCamera& camera, LabelTable table,
                  SplitOptions options);

  /// Frames must come in order. `detections` as the segmenter gave them. Where
  /// the prediction is empty, or lacks a surface, the labels and the depth of
  /// the frame before stand in for it.
  ///
  /// @throw InputError if an image does not have the camera's size.
  SplitResult Split(const Frame& frame, const PointMap& points,
                    const std::vector<InstanceMask>& detections,
                    const SurfacePrediction& prediction);

  /// Takes a detection of SplitResult::standing of the last frame for something
  /// that moves: what is found to be the same in the next frames becomes a
  /// surface at once, and until then it is no background.
  void BelieveMoving(const StandingObject& object);

  /// Every surface ever born, by id.
  const TrackTable& tracks() const { return tracks_; }
  /// One of them, to tell it how tracking went.
  Track* mutable_track(int id) { return &tracks_.at(id); }

  /// Saves or restores all that later frames depend on, see
  /// lib/base/archive.h; of a splitter with the same camera and options.
  template <typename Archive>
  void Serialize(Archive* archive) {
    archive->Section("splitter");
    (*archive)(tracks_, tentative_, objects_, last_, frames_);
  }

 private:
  /// What is given in one frame; images are HxW.
  struct Input {
    const Frame& frame;
    const PointMap& points;
    const SurfacePrediction& prior;  // Complete: never empty.
    const ComparedDepth& compared;   // Live depth with the prior.
  };

  void CheckSizes(const Frame& frame,
                  const std::vector<InstanceMask>& detections,
                  const SurfacePrediction& prediction) const;
  std::vector<Candidate> MakeCandidates(
      const std::vector<InstanceMask>& detections, const Input& input) const;
  /// Marks candidates as moved; returns what is no background therefore.
  cv::Mat_<uchar> WatchObjects(const Input& input,
                               std::vector<Candidate>* candidates);
  /// Marks candidates that were found to move before, and adds what such things
  /// that are not detected now may cover to `unconfirmed`.
  void FollowMoving(const std::vector<Match>& matches,
                    std::vector<Candidate>* candidates,
                    cv::Mat_<uchar>* unconfirmed) const;
  std::vector<StandingObject> StandingObjects(
      const std::vector<Candidate>& candidates,
      const std::vector<Match>& matches) const;
  /// Gives the detections and the predicted pixels of new surfaces that turn
  /// out to be known ones to these.
  void RecognizeReturned(int frame, LabelImage* predicted,
                         std::vector<Match>* matches,
                         std::vector<SplitDecision>* decisions);
  /// One segment a detected surface or newcomer; adds what is too weak for
  /// either to `unconfirmed`.
  std::vector<Segment> MakeSegments(const std::vector<Candidate>& candidates,
                                    const std::vector<Match>& matches,
                                    int frame, cv::Mat_<uchar>* unconfirmed,
                                    std::vector<SplitDecision>* decisions);
  void AddMissedSurfaces(std::vector<Segment>* segments) const;
  void CutSegments(const Input& input, std::vector<Segment>* segments) const;
  void SettleSurfaces(const std::vector<Segment>& segments, const Input& input,
                      std::vector<SplitDecision>* decisions);
  void SettleNewcomer(int index, const Input& input,
                      const LabelImage& segment_labels,
                      std::vector<Segment>* segments,
                      cv::Mat_<uchar>* unconfirmed,
                      std::vector<SplitDecision>* decisions);
  bool IsConfirmed(const Segment& segment, const cv::Mat_<uchar>& pixels,
                   const Input& input);
  LabelImage DrawLabels(const std::vector<Segment>& segments,
                        const LabelImage& segment_labels) const;
  /// What is neither of a surface nor surely background: unconfirmed, close to
  /// a surface, one with it in front of the background, or given to a surface
  /// by a mask or by the projection though not by the cut.
  cv::Mat DrawUncertain(const std::vector<Segment>& segments,
                        const LabelImage& labels,
                        const cv::Mat_<uchar>& unconfirmed,
                        const Input& input) const;
  void Remember(const std::vector<Segment>& segments, const SplitResult& result,
                const Input& input);

  PinholeCamera camera_;
  LabelTable table_;
  SplitOptions options_;
  std::vector<MergeGroup> groups_;
  TrackTable tracks_;
  TentativeTracks tentative_;
  MovingObjects objects_;
  SurfacePrediction last_;  // Own labels and live depth of the frame before.
  int last_frame_ = 0;      // Index.
  int frames_ = 0;          // Split so far, the current one included.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SURFACE_SPLITTER_H_
