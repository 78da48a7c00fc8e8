#ifndef SPLITFUSION_LIB_SPLIT_BIRTH_QUEUE_H_
#define SPLITFUSION_LIB_SPLIT_BIRTH_QUEUE_H_

#include <opencv2/core.hpp>
#include <vector>

namespace splitfusion {

/// Detections that may become surfaces, remembered from frame to frame.
class BirthQueue {
 public:
  /// `window`: frames for which a detection counts.
  explicit BirthQueue(int window) : window_(window) {}

  /// Records a detection (HxW, 255 inside) that fits no surface, and returns
  /// in how many of the last frames, this one included, it was seen at about
  /// the same place.
  int Add(int frame, const cv::Mat_<uchar>& mask);

  /// Forgets what was last seen where `mask` is: it became a surface.
  void Remove(const cv::Mat_<uchar>& mask);

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(entries_);
  }

 private:
  struct Entry {
    cv::Mat_<uchar> mask;     // When last seen.
    std::vector<int> frames;  // Ascending.

    template <typename Archive>
    void Serialize(Archive* archive) {
      (*archive)(mask, frames);
    }
  };

  void Forget(int frame);
  Entry* Find(const cv::Mat_<uchar>& mask);

  int window_;
  std::vector<Entry> entries_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_BIRTH_QUEUE_H_
