#include "splitfusion/lib/sequence/tum_writer.h"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/calibration.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr double kWrittenDepthScale = 5000;
const std::vector<int> kFastPng = {cv::IMWRITE_PNG_COMPRESSION, 2};

/// As in the lists of the benchmark.
std::string TimeText(double seconds) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.6f", seconds);
  return text;
}

cv::Mat_<std::uint16_t> DepthUnits(const cv::Mat_<float>& depth) {
  constexpr float kMost = 65535 / static_cast<float>(kWrittenDepthScale);
  cv::Mat_<float> near = depth.clone();
  near.setTo(0, near > kMost);
  cv::Mat units;
  near.convertTo(units, CV_16U, kWrittenDepthScale);
  return units;
}

}  // namespace

void TumWriter::Add(const std::string& stem, double timestamp,
                    const cv::Mat& color, const cv::Mat_<float>& depth) {
  if (!stems_.insert(stem).second) {
    throw InputError(folder_ + ": two depth images are called " + stem +
                     ": expected one of each name");
  }
  const std::string file = stem + ".png";
  fs::create_directories(folder_);
  WriteImage((fs::path(folder_) / "rgb" / file).string(), color, kFastPng);
  WriteImage((fs::path(folder_) / "depth" / file).string(), DepthUnits(depth),
             kFastPng);
  entries_.push_back({TimeText(timestamp), stem});
}

void TumWriter::WriteList(const std::string& kind,
                          const std::string& title) const {
  const fs::path path = fs::path(folder_) / (kind + ".txt");
  WriteFileAtomically(path.string(), [&](std::ostream& out) {
    out << "# " << title << "\n# timestamp filename\n";
    for (const Entry& entry : entries_) {
      out << entry.time << ' ' << kind << '/' << entry.stem << ".png\n";
    }
  });
}

void TumWriter::Finish(const PinholeCamera& camera,
                       const Trajectory& poses) const {
  const fs::path root = folder_;
  fs::create_directories(root);
  WriteList("rgb", "color images");
  WriteList("depth", "depth maps");
  WriteFileAtomically(
      (root / "associations.txt").string(), [&](std::ostream& out) {
        for (const Entry& entry : entries_) {
          out << entry.time << " rgb/" << entry.stem << ".png " << entry.time
              << " depth/" << entry.stem << ".png\n";
        }
      });
  Calibration calibration;
  calibration.camera = camera;
  calibration.depth_scale = kWrittenDepthScale;
  WriteCalibrationKeys((root / "camera.txt").string(), calibration);
  if (poses.empty()) return;
  WriteTumTrajectory((root / "groundtruth.txt").string(), poses);
}

}  // namespace splitfusion
