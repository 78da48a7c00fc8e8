#include "splitfusion/lib/render/depth_residuals.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/format_version.h"
#include "splitfusion/lib/base/hdf5_file.h"
#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

constexpr char kResidualsVersion[] = "format_version";

/// The columns of the file, written or read.
template <typename File>
void Visit(File* file, DepthResiduals* rows) {
  file->Column("residuals/frame", rows,
               [](DepthResidual& row) -> std::int32_t& { return row.frame; });
  file->Column("residuals/node", rows,
               [](DepthResidual& row) -> std::int32_t& { return row.node; });
  file->Column("residuals/depth", rows,
               [](DepthResidual& row) -> float& { return row.depth; });
}

}  // namespace

void AddDepthResiduals(const BestViewColors& placed, const LiveView& live,
                       const Raster& raster, DepthResiduals* residuals) {
  const FrameMotions* motions = placed.motions();
  if (motions == nullptr) return;
  const DepthNoise& noise = live.camera.noise;
  std::vector<double> sums(placed.nodes());
  std::vector<int> counts(sums.size());
  for (std::size_t i = 0; i < placed.placed().size(); ++i) {
    if (!placed.IsInUse(i)) continue;
    const float z = placed.placed()[i].z();
    const auto pixel = live.camera.PixelOf(placed.placed()[i]);
    if (!pixel) continue;
    const int v = pixel->y(), u = pixel->x();
    if (live.labels(v, u) != placed.surface() || live.edges(v, u) != 0 ||
        ClassifyDepth(raster.depth(v, u), z, kNoiseAlone.At(z, noise)) !=
            DepthState::kObserved) {
      continue;
    }
    const float depth = live.depth(v, u);
    const auto tolerance = static_cast<float>(kOneBody.At(z, noise));
    const DepthState state = ClassifyDepth(depth, z, tolerance);
    if (state != DepthState::kObserved && state != DepthState::kFree) continue;
    sums[placed.NodeOf(i)] += std::min(std::abs(depth - z), tolerance);
    ++counts[placed.NodeOf(i)];
  }
  for (std::size_t n = 0; n < sums.size(); ++n) {
    if (counts[n] == 0) continue;
    residuals->push_back({motions->frame, static_cast<std::int32_t>(n),
                          static_cast<float>(sums[n] / counts[n])});
  }
}

void WriteResiduals(const std::string& path, const DepthResiduals& residuals) {
  WritePathAtomically(path, [&](const std::string& temporary) {
    DepthResiduals copy = residuals;  // Both directions take what may change.
    Hdf5Writer file(temporary);
    std::int32_t version = kFormatVersion;
    file.Attribute(kResidualsVersion, &version);
    Visit(&file, &copy);
    file.Close();
  });
}

DepthResiduals ReadResiduals(const std::string& path) {
  DepthResiduals residuals;
  if (!std::filesystem::exists(path)) return residuals;
  Hdf5Reader file(path);
  if (file.HasAttribute(kResidualsVersion)) {
    std::int32_t version = 0;
    file.Attribute(kResidualsVersion, &version);
    CheckFormatVersion(path, nlohmann::json{{kResidualsVersion, version}});
  }
  Visit(&file, &residuals);
  return residuals;
}

}  // namespace splitfusion
