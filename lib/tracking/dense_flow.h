#ifndef SPLITFUSION_LIB_TRACKING_DENSE_FLOW_H_
#define SPLITFUSION_LIB_TRACKING_DENSE_FLOW_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

namespace splitfusion {

/// Optical flow of a part of an image to the next one and back, at every pixel:
/// dense inverse search (Kroeger et al. 2016; OpenCV's) at full resolution.
class DenseFlow {
 public:
  /// `from`, `to`: grey, HxW 8UC1. `box`: the part, within them, of both; at
  /// least 16 pixels wide and high, or OpenCV throws. `before`: HxW 32FC2
  /// (columns, rows), pixels, the flow that led from the image before to
  /// `from`, by pixels of the former; 0 where it is not known. The search
  /// begins with it, as what moves goes on: else a limb that moves by more than
  /// a stripe of its sleeve would be found at the next one.
  DenseFlow(const cv::Mat_<std::uint8_t>& from,
            const cv::Mat_<std::uint8_t>& to, const cv::Rect& box,
            const cv::Mat_<cv::Vec2f>& before);

  /// Where a pixel of `from` (column, row) is in `to`; none if one of them is
  /// outside of the box, or if the way back from there ends more than
  /// `max_return` pixels off.
  std::optional<cv::Point2f> Follow(const cv::Point2f& pixel,
                                    double max_return) const;

  /// Writes the flow into its place of an image of `from`'s size.
  void Write(cv::Mat_<cv::Vec2f>* flow) const { forth_.copyTo((*flow)(box_)); }

 private:
  cv::Rect box_;
  cv::Mat_<cv::Vec2f> forth_, back_;  // Of the box.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_DENSE_FLOW_H_
