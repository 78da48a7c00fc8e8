// Puts pictures side by side, each under its caption.

#include <gflags/gflags.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/experiment/settings.h"
#include "splitfusion/lib/report/montage.h"
#include "splitfusion/lib/sequence/image_file.h"
#include "tool_main.h"

DEFINE_string(pictures, "", "CAPTION:FILE,CAPTION:FILE,...");
DEFINE_string(output, "", "Picture to write; .jpg or .png.");
DEFINE_int32(columns, 3, "Pictures in a row.");
DEFINE_int32(tile_width, 0, "Width of each; 0 = that of the first picture.");

namespace splitfusion {
namespace {

cv::Mat Scaled(const cv::Mat& picture) {
  if (FLAGS_tile_width == 0) return picture;
  const double scale = static_cast<double>(FLAGS_tile_width) / picture.cols;
  cv::Mat scaled;
  cv::resize(picture, scaled, {}, scale, scale, cv::INTER_AREA);
  return scaled;
}

MontageTile ReadTile(const std::string& text) {
  const std::size_t colon = text.find(':');
  CheckOption(colon != std::string::npos, "pictures", text, "CAPTION:FILE");
  const std::string path = text.substr(colon + 1);
  // OpenCV would print a warning of its own.
  const bool exists = std::filesystem::is_regular_file(path);
  if (!exists) throw InputError(path + ": not found; expected a picture");
  const cv::Mat picture = cv::imread(path, cv::IMREAD_COLOR);
  if (picture.empty()) throw InputError(path + ": expected a picture");
  return {text.substr(0, colon), Scaled(picture)};
}

void WritePicture(const std::string& path, const cv::Mat& picture) {
  const std::string type = std::filesystem::path(path).extension().string();
  CheckOption(type == ".jpg" || type == ".png", "output", "'" + path + "'",
              "a name ending in .jpg or .png");
  WriteImage(path, picture, {cv::IMWRITE_JPEG_QUALITY, 85});
}

int Run() {
  CheckOption(FLAGS_tile_width >= 0 && FLAGS_tile_width <= 8192, "tile_width",
              FLAGS_tile_width, "0..8192");
  CheckOption(!FLAGS_pictures.empty(), "pictures", "''",
              "CAPTION:FILE,CAPTION:FILE,...");
  std::vector<MontageTile> tiles;
  for (const std::string& text : SplitOutsideQuotes(FLAGS_pictures, ',')) {
    tiles.push_back(ReadTile(text));
  }
  WritePicture(FLAGS_output, MakeMontage(tiles, FLAGS_columns));
  return kExitDone;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  return splitfusion::ToolMain(
      argc, argv,
      "Puts pictures side by side, each under its caption.\n"
      "  sf_montage --pictures=CAPTION:FILE,CAPTION:FILE --output=FILE.jpg\n"
      "             [--columns=N] [--tile_width=PIXELS]\n",
      splitfusion::Run);
}
