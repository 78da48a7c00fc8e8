#include "splitfusion/lib/report/frame_pictures.h"

#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/report/montage.h"
#include "splitfusion/lib/report/pictures.h"
#include "splitfusion/lib/sequence/image_file.h"

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
    WriteImage(paths.Picture(frame, item.name), item.picture);
    tiles.push_back({item.caption, item.picture});
  }
  if (tiles.empty()) return;
  WriteImage(paths.Picture(frame, "montage"), MakeMontage(tiles, 3));
}

void WriteMask(const RunPaths& paths, const std::string& stem,
               const cv::Mat& labels) {
  CheckOption(labels.type() == CV_16UC1, "labels of mask " + stem,
              cv::typeToString(labels.type()), "CV_16UC1");
  WriteImage(paths.Mask(stem), labels);
}

}  // namespace splitfusion
