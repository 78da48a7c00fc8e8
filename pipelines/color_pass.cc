#include "splitfusion/pipelines/color_pass.h"

#include <algorithm>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/read_ahead.h"
#include "splitfusion/lib/render/best_view_colors.h"
#include "splitfusion/lib/render/rasterizer.h"

namespace splitfusion {
namespace {

/// A frame, or why there is none.
struct FrameToColor {
  std::optional<PreparedFrame> prepared;
  std::string trouble;
};

/// Carries the surfaces into a frame, and labels its pixels by the one that is
/// in view of those drawn from meshes; the room is behind them.
void PlaceAndLabel(const SurfaceMap& surfaces, const PreparedFrame& prepared,
                   std::map<int, BestViewColors>* colors, Raster* raster,
                   LabelImage* labels) {
  raster->Clear(prepared.live.camera);
  std::vector<std::uint16_t> owners;  // By triangle.
  for (auto& [id, surface_colors] : *colors) {
    surface_colors.Place(prepared.frame.index);
    if (surfaces.at(id)->is_ray_cast()) continue;
    const int drawn = surface_colors.Draw(
        prepared.live.camera, static_cast<int>(owners.size()), raster);
    owners.resize(owners.size() + drawn, static_cast<std::uint16_t>(id));
  }
  for (int v = 0; v < labels->rows; ++v) {
    for (int u = 0; u < labels->cols; ++u) {
      const int triangle = raster->triangle(v, u);
      (*labels)(v, u) = triangle < 0 ? 0 : owners[triangle];
    }
  }
}

}  // namespace

std::string ColorFromBestViews(const ImageFolderReader& reader, int frames,
                               const SplitFusion& fusion, bool reads_ahead,
                               const std::function<void(int)>& shown,
                               SurfaceModels* models,
                               ResidualsById* residuals) {
  std::map<int, BestViewColors> colors;
  for (const auto& [id, surface] : fusion.surfaces()) {
    colors.try_emplace(id, id, models->at(id),
                       surface->graph_options().neighbors_per_point);
  }
  const int end = std::min(frames, reader.size());
  int next = 0;
  ReadAhead<FrameToColor> series(
      [&]() -> std::optional<FrameToColor> {
        if (next == end) return std::nullopt;
        try {
          return FrameToColor{fusion.PrepareUnsplit(reader.Read(next++)), ""};
        } catch (const std::exception& error) {
          return FrameToColor{std::nullopt, error.what()};
        }
      },
      reads_ahead);
  Raster raster;
  std::string trouble;
  int missed = 0;
  for (int done = 1;; ++done) {
    std::optional<FrameToColor> read = series.Next();
    if (!read) break;
    if (read->prepared) {
      PlaceAndLabel(fusion.surfaces(), *read->prepared, &colors, &raster,
                    &read->prepared->live.labels);
      for (auto& [id, surface_colors] : colors) {
        surface_colors.Add(read->prepared->live);
        if (fusion.surfaces().at(id)->is_ray_cast()) continue;
        AddDepthResiduals(surface_colors, read->prepared->live, raster,
                          &(*residuals)[id]);
      }
    } else if (++missed == 1) {
      trouble = read->trouble;
    }
    shown(done);
  }
  for (auto& [id, model] : *models) model.mesh.colors = colors.at(id).Colors();
  if (missed == 0) return "";
  return "no colours are taken from " + std::to_string(missed) + " of " +
         std::to_string(end) + " frames; the first: " + trouble;
}

}  // namespace splitfusion
