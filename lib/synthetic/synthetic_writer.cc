#include "splitfusion/lib/synthetic/synthetic_writer.h"

#include <tbb/parallel_invoke.h>
#include <unistd.h>

#include <filesystem>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/trajectory.h"
#include "splitfusion/lib/synthetic/ground_truth_writer.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr double kDepthFactor = 5000;  // Units per metre of depth images.

/// A folder that appears under its final name only when it is complete.
class PendingFolder {
 public:
  /// @throw InputError if the target is in the way or cannot be made.
  PendingFolder(const std::string& directory, bool overwrite)
      : target_(AbsolutePath(directory)) {
    if (!target_.has_filename()) target_ = target_.parent_path();
    CheckTarget(overwrite);
    temporary_ = Sibling(".tmp");
    std::error_code error;
    fs::create_directories(temporary_, error);
    if (error) Fail(error);
  }

  ~PendingFolder() {
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  }

  PendingFolder(const PendingFolder&) = delete;
  PendingFolder& operator=(const PendingFolder&) = delete;

  const fs::path& path() const { return temporary_; }

  /// Puts the folder in place of what was there.
  void Commit() {
    std::error_code error;
    const fs::path old = Sibling(".old");
    const bool replaces = fs::exists(target_);
    if (replaces) fs::rename(target_, old, error);
    if (!error) fs::rename(temporary_, target_, error);
    if (error) Fail(error);
    temporary_.clear();
    if (replaces) fs::remove_all(old, error);
  }

 private:
  static fs::path AbsolutePath(const std::string& directory) {
    if (directory.empty()) {
      throw InputError("directory = '': expected the folder to write");
    }
    return fs::absolute(directory).lexically_normal();
  }

  fs::path Sibling(const std::string& suffix) const {
    return target_.parent_path() / ("." + target_.filename().string() + suffix +
                                    std::to_string(getpid()));
  }

  void CheckTarget(bool overwrite) const {
    if (!fs::exists(target_)) return;
    if (!fs::is_directory(target_)) {
      throw InputError(target_.string() + ": is a file, expected a folder");
    }
    if (fs::is_empty(target_)) return;
    if (!overwrite) {
      throw InputError(target_.string() +
                       ": exists and is not empty; expected a new folder, or "
                       "the option to overwrite");
    }
    if (!fs::exists(target_ / "associations.txt")) {
      throw InputError(target_.string() +
                       ": not overwritten, since it is not a sequence (no "
                       "associations.txt)");
    }
  }

  [[noreturn]] void Fail(const std::error_code& error) const {
    throw InputError(target_.string() + ": cannot be written (" +
                     error.message() + ")");
  }

  fs::path target_;
  fs::path temporary_;
};

void WriteImage(const fs::path& path, const cv::Mat& image) {
  bool written = false;
  try {
    written =
        cv::imwrite(path.string(), image, {cv::IMWRITE_PNG_COMPRESSION, 2});
  } catch (const cv::Exception&) {
  }
  if (!written) {
    throw InputError(path.string() + ": cannot be written (disk full?)");
  }
}

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
  WriteImage(folder / (stem + ".png"), indices);
  WriteFileAtomically((folder / (stem + ".json")).string(),
                      [&](std::ostream& out) { out << list.dump() << '\n'; });
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
        [&] { WriteImage(path_ / "rgb" / file, frame.frame.color); },
        [&] {
          WriteImage(path_ / "depth" / file, depth);
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

void WriteSyntheticSequence(const SyntheticOptions& options,
                            const SyntheticWriterOptions& writer_options,
                            const std::string& directory,
                            const std::function<void(int)>& progress) {
  writer_options.Check();
  options.Check();
  PendingFolder folder(directory, writer_options.overwrite);
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
  folder.Commit();
}

}  // namespace splitfusion
