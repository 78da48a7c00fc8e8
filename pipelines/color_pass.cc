#include "splitfusion/pipelines/color_pass.h"

#include <optional>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/read_ahead.h"
#include "splitfusion/lib/render/best_view_colors.h"

namespace splitfusion {
namespace {

/// A frame, or why there is none.
struct ReadFrame {
  std::optional<PreparedFrame> prepared;
  std::string trouble;
};

}  // namespace

std::string ColorFromBestViews(const ImageFolderReader& reader, int frames,
                               const SplitFusion& fusion, bool reads_ahead,
                               SurfaceModels* models) {
  std::map<int, BestViewColors> colors;
  for (const auto& [id, surface] : fusion.surfaces()) {
    colors.try_emplace(id, models->at(id),
                       surface->graph_options().neighbors_per_point);
  }
  int next = 0;
  ReadAhead<ReadFrame> series(
      [&]() -> std::optional<ReadFrame> {
        if (next == frames) return std::nullopt;
        try {
          return ReadFrame{fusion.PrepareUnsplit(reader.Read(next++)), ""};
        } catch (const InputError& error) {
          return ReadFrame{std::nullopt, error.what()};
        }
      },
      reads_ahead);
  std::string trouble;
  while (const std::optional<ReadFrame> read = series.Next()) {
    if (!read->prepared) {
      if (trouble.empty()) {
        trouble = read->trouble + ": no colours are taken from this frame";
      }
      continue;
    }
    for (auto& [id, surface_colors] : colors) {
      surface_colors.Add(read->prepared->frame.index, read->prepared->live);
    }
  }
  for (auto& [id, model] : *models) model.mesh.colors = colors.at(id).Colors();
  return trouble;
}

}  // namespace splitfusion
