#include "splitfusion/lib/tsdf/tsdf_volume.h"

#include <openvdb/io/Stream.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <new>
#include <stdexcept>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/number_text.h"
#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/internal/packed_color.h"

namespace splitfusion {
namespace {

/// On the distance grid of a volume without colour.
constexpr char kNoColor[] = "no_color";

template <typename Grid>
typename Grid::Ptr MakeGrid(const std::string& name, double voxel_size,
                            typename Grid::ValueType background) {
  openvdb::initialize();
  auto grid = Grid::create(background);
  grid->setTransform(
      openvdb::math::Transform::createLinearTransform(voxel_size));
  grid->setName(name);
  return grid;
}

/// The grids of a file. OpenVDB does not look whether what it reads is there,
/// and takes lengths from memory that was never set when a file ends early:
/// here its end throws.
openvdb::GridPtrVecPtr ReadGrids(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path + ": cannot be opened");
  stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  return openvdb::io::Stream(stream, /*delayLoad=*/false).getGrids();
}

template <typename Grid>
typename Grid::Ptr FindGrid(const openvdb::GridPtrVec& grids,
                            const std::string& name, const std::string& path) {
  const openvdb::GridBase::Ptr found = openvdb::findGridByName(grids, name);
  if (!found) {
    throw InputError(path + ": no grid '" + name +
                     "': expected distance, weight and color");
  }
  auto grid = openvdb::gridPtrCast<Grid>(found);
  if (!grid) throw InputError(path + ": grid '" + name + "' has a wrong type");
  return grid;
}

/// Red, green and blue, 0..1.
openvdb::Vec3s Unpack(std::int32_t color) {
  openvdb::Vec3s rgb;
  for (int k = 0; k < 3; ++k) {
    rgb[k] = static_cast<float>(internal::ChannelOf(color, k)) /
             internal::kChannelEnd;
  }
  return rgb;
}

/// The nearest packed colour.
std::int32_t Pack(const openvdb::Vec3s& rgb) {
  const auto channel = [](float c) {
    // Not a number: dark.
    const float inside = c > 0 ? std::min(c, 1.0f) : 0.0f;
    return static_cast<int>(std::lround(inside * internal::kChannelEnd));
  };
  return internal::PackColor(channel(rgb[0]), channel(rgb[1]), channel(rgb[2]));
}

/// A grid of the same blocks, whose voxels are convert(voxel).
template <typename Target, typename Source, typename Function>
typename Target::Ptr Convert(const Source& source, const Function& convert) {
  auto target = MakeGrid<Target>(source.getName(), source.voxelSize()[0],
                                 convert(source.background()));
  for (auto leaf = source.tree().cbeginLeaf(); leaf; ++leaf) {
    auto* to = target->tree().touchLeaf(leaf->origin());
    to->setValueMask(leaf->getValueMask());
    const auto* from = leaf->buffer().data();
    std::transform(from, from + internal::kLeafVoxels, to->buffer().data(),
                   convert);
  }
  return target;
}

/// What the grids of others have to share with those of fusion.
///
/// @throw InputError that names the file.
void CheckDistances(const openvdb::FloatGrid& distance,
                    const std::string& path) {
  const double voxel_size = distance.voxelSize()[0];
  if (distance.transform() !=
      *openvdb::math::Transform::createLinearTransform(voxel_size)) {
    throw InputError(path +
                     ": grid 'distance' has a transform of its own: expected "
                     "cubic voxels, (0, 0, 0) at the origin");
  }
  if (!(distance.background() > 0)) {
    throw InputError(path + ": grid 'distance' has background " +
                     std::to_string(distance.background()) +
                     ": expected the truncation, metres");
  }
}

/// Meshing and ray casting rely on it that what was not observed is free space,
/// as fusion leaves it.
void FreeUnobserved(const internal::LeafBuffers& leaf, float free_space) {
  for (int i = 0; i < internal::kLeafVoxels; ++i) {
    const bool observed = leaf.weight[i] > 0 && std::isfinite(leaf.weight[i]) &&
                          std::isfinite(leaf.distance[i]);
    if (observed) continue;
    leaf.distance[i] = free_space;
    leaf.weight[i] = 0;
  }
}

}  // namespace

void TsdfOptions::List(OptionList* list) {
  // Finer voxels would need more memory than there is, and end in OpenVDB.
  list->Number("voxel", &voxel_size, {0.001, 1, false, true}, "metres",
               "Edge length of a voxel.")
      .common = true;
  list->Number("truncation", &truncation, Range::Above(0), "metres",
               "Truncation distance, 2 to 50 voxels.");
  list->Demand(truncation >= 2 * voxel_size && truncation <= 50 * voxel_size,
               "truncation",
               "2 to 50 voxels (" + NumberText(2 * voxel_size) + " to " +
                   NumberText(50 * voxel_size) + " metres)");
  list->Number("max_weight", &max_weight, Range::AtLeast(1), "",
               "Largest weight of a voxel in the running mean.");
  list->Number("reach_sigmas", &reach_sigmas, {0, 10}, "",
               "Voxels are written so many standard deviations of the depth "
               "noise behind a measurement, but at least the truncation.");
  list->Number("min_block_pixels", &min_block_pixels, Range::AtLeast(1),
               "pixels",
               "Blocks of voxels for which fewer pixels of a frame ask are "
               "noise and are not made (surfaces that are carried rigidly).");
}

void TsdfOptions::Check() const { CheckOptions(*this); }

void TsdfVolume::Grids::Touch(const openvdb::Coord& origin) {
  const auto [x, y, z] = internal::PlaceOf(origin);
  if (table.Find(x, y, z) != 0) return;
  // OpenVDB meshes and prunes by active voxels; here a block is in use as a
  // whole, and the weight says what was observed.
  internal::LeafBuffers leaf;
  leaf.origin = origin;
  const auto touch = [&](auto* tree, auto** buffer) {
    auto* touched = tree->touchLeaf(origin);
    touched->setValuesOn();
    *buffer = touched->buffer().data();
  };
  touch(&distance->tree(), &leaf.distance);
  touch(&weight->tree(), &leaf.weight);
  if (color != nullptr) touch(&color->tree(), &leaf.color);
  leaves.push_back(leaf);
  states.emplace_back();
  table.Insert({x, y, z}, static_cast<std::int32_t>(leaves.size()));
}

void TsdfVolume::Grids::Enter() {
  for (auto leaf = distance->tree().beginLeaf(); leaf; ++leaf) {
    Touch(leaf->origin());
    FreeUnobserved(leaves.back(), distance->background());
    RecordChange(leaves.size() - 1,
                 internal::HasInside(internal::ToFused(leaves.back())));
  }
}

TsdfVolume::TsdfVolume(const TsdfOptions& options)
    : options_(options), grids_(std::make_unique<Grids>()) {
  options.Check();
  grids_->distance = MakeGrid<openvdb::FloatGrid>(
      "distance", options.voxel_size, static_cast<float>(options.truncation));
  grids_->weight =
      MakeGrid<openvdb::FloatGrid>("weight", options.voxel_size, 0.0f);
  if (!options.has_color) return;
  grids_->color = MakeGrid<openvdb::Int32Grid>("color", options.voxel_size, 0);
}

TsdfVolume::~TsdfVolume() = default;
TsdfVolume::TsdfVolume(TsdfVolume&&) noexcept = default;
TsdfVolume& TsdfVolume::operator=(TsdfVolume&&) noexcept = default;

std::size_t TsdfVolume::leaf_count() const { return grids_->leaves.size(); }

void TsdfVolume::Write(const std::string& path) const {
  WritePathAtomically(path, [&](const std::string& temporary) {
    try {
      grids_->distance->insertMeta(
          "truncation", openvdb::DoubleMetadata(options_.truncation));
      grids_->distance->insertMeta(
          "max_weight", openvdb::DoubleMetadata(options_.max_weight));
      openvdb::GridPtrVec grids = {grids_->distance, grids_->weight};
      if (options_.has_color) {
        grids.push_back(Convert<openvdb::Vec3SGrid>(*grids_->color, Unpack));
      } else {
        grids_->distance->insertMeta(kNoColor, openvdb::BoolMetadata(true));
      }
      openvdb::io::File file(temporary);
      file.write(grids);
      file.close();
    } catch (const openvdb::Exception& e) {
      throw InputError(path + ": cannot be written (" + e.what() + ")");
    }
  });
}

TsdfVolume TsdfVolume::Read(const std::string& path) {
  openvdb::initialize();
  try {
    const openvdb::GridPtrVecPtr all = ReadGrids(path);
    Grids grids;
    grids.distance = FindGrid<openvdb::FloatGrid>(*all, "distance", path);
    grids.weight = FindGrid<openvdb::FloatGrid>(*all, "weight", path);
    CheckDistances(*grids.distance, path);
    TsdfOptions options;
    options.has_color =
        grids.distance->getMetadata<openvdb::BoolMetadata>(kNoColor) == nullptr;
    if (options.has_color) {
      const auto color = FindGrid<openvdb::Vec3SGrid>(*all, "color", path);
      color->tree().voxelizeActiveTiles();  // Others prune.
      grids.color = Convert<openvdb::Int32Grid>(*color, Pack);
    }
    options.voxel_size = grids.distance->voxelSize()[0];
    options.truncation = grids.distance->metaValue<double>("truncation");
    options.max_weight = grids.distance->metaValue<double>("max_weight");
    TsdfVolume volume(options);
    grids.Enter();
    *volume.grids_ = std::move(grids);
    return volume;
  } catch (const std::ios::failure&) {
    throw InputError(path + ": not a readable volume (it ends early)");
  } catch (const openvdb::Exception& e) {
    throw InputError(path + ": not a readable volume (" + e.what() + ")");
  } catch (const std::bad_alloc&) {
    throw InputError(path + ": not a readable volume (absurd sizes)");
  } catch (const std::length_error&) {
    throw InputError(path + ": not a readable volume (absurd sizes)");
  }
}

namespace internal {

FusedLeaf ToFused(const LeafBuffers& leaf) {
  return {leaf.distance, leaf.weight, leaf.color};
}

}  // namespace internal
}  // namespace splitfusion
