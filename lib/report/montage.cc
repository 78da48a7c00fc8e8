#include "splitfusion/lib/report/montage.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr int kTileGap = 4;  // Pixels between tiles.

void CheckTiles(const std::vector<MontageTile>& tiles, int columns) {
  CheckOption(columns > 0, "columns", columns, "at least 1");
  CheckOption(!tiles.empty(), "montage tiles", tiles.size(), "at least 1");
  for (const MontageTile& tile : tiles) {
    CheckOption(tile.picture.type() == CV_8UC3 && !tile.picture.empty(),
                "montage tile '" + tile.caption + "'",
                cv::typeToString(tile.picture.type()), "a CV_8UC3 picture");
  }
}

void DrawTile(const MontageTile& tile, const cv::Rect& place, cv::Mat* sheet) {
  cv::Mat target = (*sheet)(place);
  if (tile.picture.size() == place.size()) {
    tile.picture.copyTo(target);
  } else {
    cv::resize(tile.picture, target, place.size(), 0, 0, cv::INTER_AREA);
  }
  cv::putText(*sheet, tile.caption, {place.x + 2, place.y - 7},
              cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar::all(0), 1,
              cv::LINE_AA);
}

}  // namespace

cv::Mat MakeMontage(const std::vector<MontageTile>& tiles, int columns) {
  CheckTiles(tiles, columns);
  const int count = static_cast<int>(tiles.size());
  columns = std::min(columns, count);
  const int rows = (count + columns - 1) / columns;
  const cv::Size size = tiles.front().picture.size();
  const cv::Size step(size.width + kTileGap,
                      size.height + kCaptionHeight + kTileGap);
  cv::Mat sheet(rows * step.height - kTileGap, columns * step.width - kTileGap,
                CV_8UC3, cv::Scalar::all(255));
  for (int i = 0; i < count; ++i) {
    const cv::Point corner(i % columns * step.width,
                           i / columns * step.height + kCaptionHeight);
    DrawTile(tiles[i], {corner, size}, &sheet);
  }
  return sheet;
}

}  // namespace splitfusion
