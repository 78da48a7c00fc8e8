#include "splitfusion/lib/report/frame_pictures.h"

#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/report/montage.h"
#include "splitfusion/lib/report/pictures.h"

namespace splitfusion {
namespace {

/// A picture of the frame: its part of the file name and its caption.
struct NamedPicture {
  std::string name;
  std::string caption;
  cv::Mat picture;
};

std::vector<NamedPicture> MakePictures(const FrameImages& images) {
  std::vector<NamedPicture> pictures;
  const bool has_color = !images.color.empty();
  const bool has_model = !images.model_depth.empty();
  if (has_color) pictures.push_back({"input", "input", images.color});
  if (has_color && !images.labels.empty()) {
    pictures.push_back(
        {"labels", "surfaces", LabelPicture(images.color, images.labels)});
  }
  if (has_model && !images.model_color.empty()) {
    pictures.push_back(
        {"composite", "model colour",
         CompositePicture(images.model_color, images.model_depth)});
  }
  if (!images.model_normals.empty()) {
    pictures.push_back(
        {"normals", "model normals", NormalPicture(images.model_normals)});
  }
  if (has_model) {
    pictures.push_back(
        {"depth", "model depth, 0.4 to 5 m", DepthPicture(images.model_depth)});
  }
  if (has_model && !images.depth.empty()) {
    pictures.push_back({"error", "|model - live| depth, 0 to 5 cm",
                        ErrorPicture(images.model_depth, images.depth)});
  }
  return pictures;
}

}  // namespace

void WriteFramePictures(const RunPaths& paths, int frame,
                        const FrameImages& images) {
  std::vector<MontageTile> tiles;
  for (const NamedPicture& item : MakePictures(images)) {
    WritePng(paths.Picture(frame, item.name), item.picture);
    tiles.push_back({item.caption, item.picture});
  }
  if (tiles.empty()) return;
  WritePng(paths.Picture(frame, "montage"), MakeMontage(tiles, 3));
}

void WriteMask(const RunPaths& paths, const std::string& stem,
               const cv::Mat& labels) {
  CheckOption(labels.type() == CV_16UC1, "labels of mask " + stem,
              cv::typeToString(labels.type()), "CV_16UC1");
  WritePng(paths.Mask(stem), labels);
}

void WritePng(const std::string& path, const cv::Mat& picture) {
  WritePathAtomically(path, [&](const std::string& temporary) {
    bool written = false;
    try {
      written = cv::imwrite(temporary, picture);
    } catch (const cv::Exception&) {
      written = false;
    }
    if (!written) {
      throw InputError(path +
                       ": cannot be written (folder missing, not "
                       "writable or disk full)");
    }
  });
}

}  // namespace splitfusion
