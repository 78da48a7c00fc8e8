#include <cstdio>
#include <filesystem>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/container_formats.h"
#include "splitfusion/lib/sequence/open_files.h"
#include "splitfusion/lib/sequence/ros_bag.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr double kBagTolerance = 0.02;   // Seconds.
constexpr double kBagDepthScale = 1000;  // Of 16UC1, by ROS' REP 118.

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A bag with the topics of its depth and colour.
class RgbdBag {
 public:
  explicit RgbdBag(const std::string& path) : bag_(OpenRosBag(path)) {
    for (const std::string& name : bag_->ImageTopics()) {
      Choose(name, IsDepthTopic(name) ? &depth_ : &color_);
    }
    if (depth_.empty() || color_.empty()) {
      throw InputError(path +
                       ": no images of depth and colour: expected topics of "
                       "sensor_msgs with 'depth', and with 'rgb' or 'color'");
    }
    const std::vector<std::vector<double>> times =
        bag_->Times({color_, depth_});
    frames_ = AssociateByTime(Timed("rgb", times[0]), Timed("depth", times[1]),
                              kBagTolerance);
  }

  /// Whether depth is said to be registered to colour.
  bool IsRegistered() const { return Preference(depth_) > 0; }

  const std::vector<AssociatedFiles>& frames() const { return frames_; }

  cv::Mat Read(bool depth, int i) const {
    return bag_->Image(depth ? depth_ : color_, i);
  }

  /// Of the camera of a topic, if that says anything.
  std::optional<Calibration> Camera(bool depth) const {
    // "/camera/rgb/image_raw" and "/camera/rgb/image_raw/compressed" have
    // "/camera/rgb/camera_info".
    for (fs::path at = depth ? depth_ : color_; at.has_relative_path();) {
      at = at.parent_path();
      const std::string name = (at / "camera_info").string();
      if (bag_->HasCamera(name)) return bag_->Camera(name);
    }
    return std::nullopt;
  }

 private:
  static bool IsDepthTopic(const std::string& name) {
    return Contains(name, "depth") || Contains(name, "Depth");
  }

  /// Of several topics that with the greatest.
  static int Preference(const std::string& name) {
    return Contains(name, "registered") || Contains(name, "aligned") ? 1 : 0;
  }

  void Choose(const std::string& name, std::string* chosen) const {
    const bool is_color = chosen == &color_;
    if (is_color && !Contains(name, "rgb") && !Contains(name, "color") &&
        !Contains(name, "Color")) {
      return;
    }
    if (chosen->empty() || Preference(name) > Preference(*chosen)) {
      *chosen = name;
    }
  }

  static std::vector<TimedFile> Timed(const std::string& folder,
                                      const std::vector<double>& times) {
    std::vector<TimedFile> files;
    for (std::size_t i = 0; i < times.size(); ++i) {
      char name[32];
      std::snprintf(name, sizeof(name), "/%06zu.png", i);
      files.push_back({times[i], folder + name});
    }
    return files;
  }

  std::unique_ptr<RosBag> bag_;
  std::string depth_;  // Names of topics.
  std::string color_;
  std::vector<AssociatedFiles> frames_;
};

class RosBagFormat : public SequenceFormat {
 public:
  std::string Files() const override { return "a file *.bag of ROS 1"; }

  bool Recognises(const std::string& sequence) const override {
    return fs::path(sequence).extension() == ".bag" &&
           fs::is_regular_file(sequence);
  }

  std::vector<AssociatedFiles> FindFrames(
      const std::string& sequence) const override {
    std::vector<AssociatedFiles> frames = bags_.At(sequence)->frames();
    if (!frames.empty()) return frames;
    throw InputError(sequence +
                     ": 0 frames: expected colour and depth within 0.02 s");
  }

  std::optional<Calibration> FindCalibration(
      const std::string& sequence) const override {
    const std::shared_ptr<const RgbdBag> bag = bags_.At(sequence);
    // Registered depth is in the colour camera.
    std::optional<Calibration> found = bag->Camera(!bag->IsRegistered());
    if (!found) found = bag->Camera(bag->IsRegistered());
    if (found) found->depth_scale = kBagDepthScale;
    return found;
  }

  std::optional<ImageHeader> ReadColorHeader(
      const std::string&) const override {
    return std::nullopt;
  }
  std::optional<ImageHeader> ReadDepthHeader(
      const std::string&) const override {
    return std::nullopt;
  }

  cv::Mat ReadColor(const std::string& path) const override {
    return Checked(path, Read(path, /*depth=*/false), CV_8UC3, CV_8UC3);
  }
  cv::Mat ReadDepth(const std::string& path) const override {
    return Checked(path, Read(path, /*depth=*/true), CV_16UC1, CV_32FC1);
  }

 private:
  /// FindFrames() made the name, "take.bag/depth/000012.png".
  cv::Mat Read(const std::string& path, bool depth) const {
    const fs::path file = path;
    return bags_.At(file.parent_path().parent_path().string())
        ->Read(depth, std::stoi(file.stem().string()));
  }

  static cv::Mat Checked(const std::string& path, cv::Mat image, int type,
                         int other_type) {
    if (image.type() == type || image.type() == other_type) return image;
    throw InputError(path +
                     ": an image of another kind: expected colour of 8 bit, "
                     "depth of 16UC1 or 32FC1");
  }

  mutable OpenFiles<RgbdBag> bags_;
};

}  // namespace

std::unique_ptr<SequenceFormat> MakeRosBagFormat() {
  return std::make_unique<RosBagFormat>();
}

}  // namespace splitfusion
