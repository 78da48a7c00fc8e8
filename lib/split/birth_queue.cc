#include "splitfusion/lib/split/birth_queue.h"

#include <algorithm>

namespace splitfusion {
namespace {

/// Smallest IoU of two masks of one thing in two frames. People who walk in
/// grow fast, hence the low value.
constexpr double kMinIou = 0.15;

double Iou(const cv::Mat& a, const cv::Mat& b) {
  const int common = cv::countNonZero(a & b);
  return common == 0 ? 0.0 : double(common) / cv::countNonZero(a | b);
}

}  // namespace

int BirthQueue::Add(int frame, const cv::Mat_<uchar>& mask) {
  Forget(frame);
  Entry* entry = Find(mask);
  if (entry == nullptr) entry = &entries_.emplace_back();
  entry->mask = mask.clone();
  if (entry->frames.empty() || entry->frames.back() != frame) {
    entry->frames.push_back(frame);
  }
  return static_cast<int>(entry->frames.size());
}

void BirthQueue::Remove(const cv::Mat_<uchar>& mask) {
  if (Entry* entry = Find(mask)) {
    entries_.erase(entries_.begin() + (entry - entries_.data()));
  }
}

void BirthQueue::Forget(int frame) {
  for (Entry& entry : entries_) {
    auto& frames = entry.frames;
    frames.erase(frames.begin(),
                 std::find_if(frames.begin(), frames.end(), [&](int seen) {
                   return seen > frame - window_;
                 }));
  }
  entries_.erase(
      std::remove_if(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.frames.empty(); }),
      entries_.end());
}

BirthQueue::Entry* BirthQueue::Find(const cv::Mat_<uchar>& mask) {
  Entry* best = nullptr;
  double best_iou = kMinIou;
  for (Entry& entry : entries_) {
    const double iou = Iou(mask, entry.mask);
    if (iou < best_iou) continue;
    best_iou = iou;
    best = &entry;
  }
  return best;
}

}  // namespace splitfusion
