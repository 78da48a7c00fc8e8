#ifndef SPLITFUSION_LIB_SPLIT_INSTANCE_REGISTRY_H_
#define SPLITFUSION_LIB_SPLIT_INSTANCE_REGISTRY_H_

#include <map>
#include <opencv2/core.hpp>
#include <set>
#include <string>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/segmentation/label_table.h"

namespace splitfusion {

/// A surface the splitter follows.
struct TrackedInstance {
  int id = 0;              ///< From 1, in order of birth, never reused.
  std::string class_name;  ///< Majority of its detections, by score.
  SurfaceKind kind = SurfaceKind::kNonRigid;  ///< Of its class at birth.
  int first_frame = 0;                        ///< Frame of its birth.
  int last_detected_frame = 0;  ///< Latest frame with a detection of it.
  bool dormant = false;  ///< Not followed: out of view or missed too long.
  int merged_into = 0;   ///< Surface it turned out to be a part of; 0 = none.
  /// Surface that holds it, so that its pixels belong to Whole() meanwhile;
  /// 0 = none.
  int held_by = 0;

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(id, class_name, kind, first_frame, last_detected_frame, dormant,
               merged_into, held_by);
  }
};

/// Appearance of an instance, by which it is recognised when it comes back.
struct Appearance {
  cv::Mat histogram;  ///< 8x8x8 BGR, sum 1; empty if never seen.
  cv::Vec3f center;   ///< Mean point, camera frame, metres.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(histogram, center);
  }
};

/// Appearance of the pixels inside of `mask` (HxW, 255 inside).
Appearance ComputeAppearance(const cv::Mat& color, const PointMap& points,
                             const cv::Mat_<uchar>& mask);

/// 0..1: intersection of the histograms; 0 if the centres are more than
/// `max_distance` (metres) apart or one has never been seen.
double AppearanceSimilarity(const Appearance& a, const Appearance& b,
                            double max_distance);

/// The identity of every instance ever born, and what is known of it.
class InstanceRegistry {
 public:
  /// Adds an instance and returns its id.
  int Create(int frame, const std::string& class_name, SurfaceKind kind);

  /// Records a detection: class vote, last frame; wakes a dormant instance.
  void RecordDetection(int id, int frame, const std::string& class_name,
                       double score);

  /// Replaces the appearance, once the pixels of a detected instance are known.
  void RecordAppearance(int id, const Appearance& appearance);

  /// Stops following an instance until it is detected again.
  void SetDormant(int id) { instances_.at(id).dormant = true; }

  /// Counts a frame in which a detection of `body` covered `part` too, and
  /// returns the count.
  int CountCovered(int part, int body) { return ++covered_[{part, body}]; }

  /// `part` was never an instance of its own.
  void Merge(int part, int body);

  /// The pixels of `part` belong to the whole of `body` from now on; its id
  /// stays its own. `part` may not be the whole of `body`.
  void Hold(int part, int body);

  /// Counts a frame in which a held part was seen apart from what holds it, and
  /// returns the count since they last touched.
  int CountApart(int part) { return ++apart_[part]; }

  /// Nothing holds the part any more.
  void Release(int part) { instances_.at(part).held_by = 0; }

  /// Surface that an instance is a part of at present: what holds it, or what
  /// holds that, and so on; itself if nothing does.
  int Whole(int id) const;

  /// Latest surface that held a part; 0 if none ever did.
  int LastHolder(int part) const;

  /// The instance of this kind, of these `ids`, that looks most like
  /// `appearance`; 0 if none is alike.
  int FindAlike(const Appearance& appearance, SurfaceKind kind,
                const std::set<int>& ids, int frame) const;

  /// Ids that detections may be matched to: all but merged ones.
  std::set<int> Matchable() const;

  /// Ids of those that are not followed, but may come back.
  std::set<int> Dormant() const;

  /// Ids of the instances that should be in view: neither merged nor dormant.
  std::set<int> Followed() const;

  /// The instance of an id that was born.
  const TrackedInstance& at(int id) const { return instances_.at(id); }
  /// Every instance ever born, by id.
  const std::map<int, TrackedInstance>& instances() const { return instances_; }

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(instances_, votes_, appearances_, covered_, last_holder_,
               apart_);
  }

 private:
  std::map<int, TrackedInstance> instances_;
  std::map<int, std::map<std::string, double>> votes_;  // [id][class]
  std::map<int, Appearance> appearances_;
  std::map<std::pair<int, int>, int> covered_;
  std::map<int, int> last_holder_;  // By part.
  std::map<int, int> apart_;        // By part.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_INSTANCE_REGISTRY_H_
