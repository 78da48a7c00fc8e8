#include "splitfusion/lib/tsdf/tsdf_volume.h"

#include <openvdb/io/Stream.h>

#include <fstream>
#include <mutex>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/tsdf/internal/grids.h"

namespace splitfusion {
namespace {

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

}  // namespace

void TsdfOptions::Check() const {
  CheckOption(voxel_size > 0 && voxel_size < 1, "voxel_size", voxel_size,
              "metres between 0 and 1");
  CheckOption(truncation >= 2 * voxel_size && truncation <= 50 * voxel_size,
              "truncation", truncation,
              "2 to 50 voxels (" + std::to_string(2 * voxel_size) + " to " +
                  std::to_string(50 * voxel_size) + " m)");
  CheckOption(max_weight >= 1, "max_weight", max_weight, ">= 1");
  CheckOption(max_free_weight > 0, "max_free_weight", max_free_weight, "> 0");
}

void TsdfVolume::Grids::Touch(const openvdb::Coord& origin) {
  // OpenVDB meshes and prunes by active voxels; here a block is in use as a
  // whole, and the weight says what was observed.
  distance->tree().touchLeaf(origin)->setValuesOn();
  weight->tree().touchLeaf(origin)->setValuesOn();
  color->tree().touchLeaf(origin)->setValuesOn();
}

TsdfVolume::TsdfVolume(const TsdfOptions& options)
    : options_(options), grids_(std::make_unique<Grids>()) {
  options.Check();
  grids_->distance = MakeGrid<openvdb::FloatGrid>(
      "distance", options.voxel_size, static_cast<float>(options.truncation));
  grids_->weight =
      MakeGrid<openvdb::FloatGrid>("weight", options.voxel_size, 0.0f);
  grids_->color = MakeGrid<openvdb::Vec3SGrid>("color", options.voxel_size,
                                               openvdb::Vec3s(0, 0, 0));
}

TsdfVolume::~TsdfVolume() = default;
TsdfVolume::TsdfVolume(TsdfVolume&&) noexcept = default;
TsdfVolume& TsdfVolume::operator=(TsdfVolume&&) noexcept = default;

std::size_t TsdfVolume::leaf_count() const {
  return grids_->distance->tree().leafCount();
}

void TsdfVolume::Write(const std::string& path) const {
  WritePathAtomically(path, [&](const std::string& temporary) {
    try {
      grids_->distance->insertMeta(
          "truncation", openvdb::DoubleMetadata(options_.truncation));
      grids_->distance->insertMeta(
          "max_weight", openvdb::DoubleMetadata(options_.max_weight));
      openvdb::io::File file(temporary);
      file.write({grids_->distance, grids_->weight, grids_->color});
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
    Grids grids{FindGrid<openvdb::FloatGrid>(*all, "distance", path),
                FindGrid<openvdb::FloatGrid>(*all, "weight", path),
                FindGrid<openvdb::Vec3SGrid>(*all, "color", path),
                {},
                0};
    TsdfOptions options;
    options.voxel_size = grids.distance->voxelSize()[0];
    options.truncation = grids.distance->metaValue<double>("truncation");
    options.max_weight = grids.distance->metaValue<double>("max_weight");
    TsdfVolume volume(options);
    *volume.grids_ = grids;
    return volume;
  } catch (const std::ios::failure&) {
    throw InputError(path + ": not a readable volume (it ends early)");
  } catch (const openvdb::Exception& e) {
    throw InputError(path + ": not a readable volume (" + e.what() + ")");
  }
}

namespace internal {

std::vector<LeafBuffers> CollectLeaves(TsdfVolume* volume) {
  TsdfVolume::Grids& grids = volume->grids();
  std::vector<LeafBuffers> leaves;
  leaves.reserve(volume->leaf_count());
  auto weight = grids.weight->tree().beginLeaf();
  auto color = grids.color->tree().beginLeaf();
  for (auto leaf = grids.distance->tree().beginLeaf(); leaf;
       ++leaf, ++weight, ++color) {
    leaves.push_back({leaf->origin(), leaf->buffer().data(),
                      weight->buffer().data(), color->buffer().data()});
  }
  return leaves;
}

std::vector<ConstLeafBuffers> CollectLeaves(const TsdfVolume& volume) {
  const TsdfVolume::Grids& grids = volume.grids();
  std::vector<ConstLeafBuffers> leaves;
  leaves.reserve(volume.leaf_count());
  auto weight = grids.weight->tree().cbeginLeaf();
  auto color = grids.color->tree().cbeginLeaf();
  for (auto leaf = grids.distance->tree().cbeginLeaf(); leaf;
       ++leaf, ++weight, ++color) {
    leaves.push_back({leaf->origin(), leaf->buffer().data(),
                      weight->buffer().data(), color->buffer().data()});
  }
  return leaves;
}

FusedLeaf ToFused(const LeafBuffers& leaf) {
  static_assert(sizeof(openvdb::Vec3s) == 3 * sizeof(float));
  return {leaf.distance, leaf.weight, leaf.color->asPointer()};
}

void RecordChanges(const std::vector<LeafBuffers>& leaves,
                   const std::vector<char>& changed, TsdfVolume* volume) {
  TsdfVolume::Grids& grids = volume->grids();
  ++grids.time;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (changed[i]) grids.changed[leaves[i].origin] = grids.time;
  }
}

}  // namespace internal
}  // namespace splitfusion
