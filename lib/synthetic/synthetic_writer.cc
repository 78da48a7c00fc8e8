#include "splitfusion/lib/synthetic/synthetic_writer.h"

#include <tbb/parallel_invoke.h>

#include <filesystem>
#include <iomanip>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/base/pending_folder.h"
#include "splitfusion/lib/sequence/image_file.h"
#include "splitfusion/lib/sequence/trajectory.h"
#include "splitfusion/lib/synthetic/ground_truth_writer.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr double kDepthFactor = 5000;    // Units per metre of depth images.
constexpr char kProgram[] = "sf_synth";  // Of the marker.

const std::vector<int> kPng = {cv::IMWRITE_PNG_COMPRESSION, 2};

nlohmann::json ToJson(const InstanceMask& detection, int index) {
  const cv::Rect box = cv::boundingRect(detection.mask);
  return {{"index", index},
          {"class", detection.class_name},
          {"score", std::round(detection.score * 1000) / 1000},
          {"bbox", {box.x, box.y, box.br().x - 1, box.br().y - 1}}};
}

/// Worse detections are drawn first, so that better ones cover them.
void WriteDetections(const fs::path& folder, const std::string& stem,
                     const std::vector<InstanceMask>& detections,
                     const cv::Size& size) {
  cv::Mat indices = cv::Mat::zeros(size, CV_8UC1);
  nlohmann::json list = nlohmann::json::array();
  for (int i = static_cast<int>(detections.size()); i > 0; --i) {
    indices.setTo(i, detections[i - 1].mask);
  }
  for (std::size_t i = 0; i < detections.size(); ++i) {
    list.push_back(ToJson(detections[i], static_cast<int>(i) + 1));
  }
  WriteImage(folder / (stem + ".png"), indices, kPng);
  WriteJson((folder / (stem + ".json")).string(), list);
}

class SequenceFolder {
 public:
  SequenceFolder(const fs::path& path, const SyntheticScene& scene)
      : path_(path), scene_(scene) {
    for (const char* folder : {"rgb", "depth", "masks_noisy"}) {
      fs::create_directories(path_ / folder);
    }
  }

  void WriteFrame(const SyntheticFrame& frame) const {
    const std::string file = frame.frame.stem + ".png";
    cv::Mat depth;
    frame.frame.depth.convertTo(depth, CV_16UC1, kDepthFactor);
    tbb::parallel_invoke(
        [&] { WriteImage(path_ / "rgb" / file, frame.frame.color, kPng); },
        [&] {
          WriteImage(path_ / "depth" / file, depth, kPng);
          WriteDetections(path_ / "masks_noisy", frame.frame.stem,
                          scene_.Detections(frame), depth.size());
        });
  }

  void WriteTexts() const {
    WriteList("rgb", "color images");
    WriteList("depth", "depth maps");
    Write("associations.txt", [&](std::ostream& out) {
      for (int i = 0; i < scene_.options().frames; ++i) {
        const std::string stem = scene_.Stem(i);
        out << stem << " rgb/" << stem << ".png " << stem << " depth/" << stem
            << ".png\n";
      }
    });
    Write("calibration.txt", [&](std::ostream& out) {
      const PinholeCamera& c = scene_.camera();
      out << std::setprecision(12)
          << "# fx fy cx cy width height depth_factor\n"
          << c.fx << ' ' << c.fy << ' ' << c.cx << ' ' << c.cy << ' ' << c.width
          << ' ' << c.height << ' ' << kDepthFactor << '\n';
    });
  }

 private:
  void Write(const std::string& name,
             const std::function<void(std::ostream&)>& write) const {
    WriteFileAtomically((path_ / name).string(), write);
  }

  void WriteList(const std::string& folder, const std::string& title) const {
    Write(folder + ".txt", [&](std::ostream& out) {
      out << "# " << title << "\n# timestamp filename\n#\n";
      for (int i = 0; i < scene_.options().frames; ++i) {
        const std::string stem = scene_.Stem(i);
        out << stem << ' ' << folder << '/' << stem << ".png\n";
      }
    });
  }

  fs::path path_;
  const SyntheticScene& scene_;
};

}  // namespace

void SyntheticWriterOptions::Check() const {
  CheckOption(mesh_every >= 1, "mesh_every", mesh_every, "1 or more frames");
  CheckOption(seen_every >= 1, "seen_every", seen_every, "1 or more frames");
}

std::vector<std::string> WriteSyntheticSequence(
    const SyntheticOptions& options,
    const SyntheticWriterOptions& writer_options, const std::string& directory,
    const std::function<void(int)>& progress) {
  writer_options.Check();
  options.Check();
  PendingFolder folder(directory, kProgram, writer_options.overwrite);
  const SyntheticScene scene(options);
  const SequenceFolder sequence(folder.path(), scene);
  GroundTruthWriter truth((folder.path() / "gt").string(), scene,
                          writer_options);
  for (int i = 0; i < options.frames; ++i) {
    const SyntheticFrame frame = scene.Render(i);
    tbb::parallel_invoke([&] { sequence.WriteFrame(frame); },
                         [&] { truth.AddFrame(frame); });
    if (progress) progress(i + 1);
  }
  sequence.WriteTexts();
  truth.Finish();
  fs::copy_file(folder.path() / "gt" / "groundtruth.txt",
                folder.path() / "groundtruth.txt");
  return folder.Commit();
}

}  // namespace splitfusion
