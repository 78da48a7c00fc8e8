#include "splitfusion/lib/tsdf/mesh_extractor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/internal/leaf_mesh.h"

namespace splitfusion {
namespace {

using internal::kLeafSize;
using internal::LeafMesh;
using openvdb::Coord;

/// Orders blocks as OpenVDB's tree has them.
struct TreeOrder {
  static auto Key(const Coord& c, int shift, int mask) {
    return std::make_tuple((c.x() >> shift) & mask, (c.y() >> shift) & mask,
                           (c.z() >> shift) & mask);
  }
  bool operator()(const Coord& a, const Coord& b) const {
    for (const auto& [shift, mask] : {std::pair(12, -1), {7, 31}, {3, 15}}) {
      const auto key_a = Key(a, shift, mask), key_b = Key(b, shift, mask);
      if (key_a != key_b) return key_a < key_b;
    }
    return false;
  }
};

/// The given blocks and all from `low` to `high` blocks away along every axis.
std::vector<Coord> WithNeighbors(const std::vector<Coord>& origins, int low,
                                 int high) {
  std::vector<Coord> all;
  internal::LeafTable numbers;
  const auto add = [&](const Coord& origin) {
    const internal::LeafPlace place = internal::PlaceOf(origin);
    if (numbers.Find(place[0], place[1], place[2]) != 0) return;
    all.push_back(origin);
    numbers.Insert(place, static_cast<std::int32_t>(all.size()));
  };
  for (const Coord& origin : origins) {
    for (int x = low; x <= high; ++x) {
      for (int y = low; y <= high; ++y) {
        for (int z = low; z <= high; ++z) {
          add(origin.offsetBy(kLeafSize * x, kLeafSize * y, kLeafSize * z));
        }
      }
    }
  }
  return all;
}

}  // namespace

struct MeshExtractor::Blocks {
  std::map<Coord, std::unique_ptr<LeafMesh>, TreeOrder> meshes;
  int time = -1;  // Of the volume's last change that is in the meshes.

  const LeafMesh* Find(const Coord& origin) const {
    const auto found = meshes.find(origin);
    return found == meshes.end() ? nullptr : found->second.get();
  }

  std::vector<Coord> Changed(const TsdfVolume& volume) const;
  std::vector<Coord> Remesh(const TsdfVolume& volume,
                            const internal::LeafLookup& lookup,
                            float min_weight,
                            const std::vector<Coord>& origins);
  void ConnectAnew(const std::vector<Coord>& origins);
  TriangleMesh Join(std::vector<int>* kept_from);
};

/// Blocks whose voxels changed since the last time.
std::vector<Coord> MeshExtractor::Blocks::Changed(
    const TsdfVolume& volume) const {
  const TsdfVolume::Grids& grids = volume.grids();
  std::vector<Coord> changed;
  for (std::size_t i = 0; i < grids.leaves.size(); ++i) {
    if (time < 0 || grids.states[i].changed > time) {
      changed.push_back(grids.leaves[i].origin);
    }
  }
  return changed;
}

/// Makes the vertices of blocks anew; gives those that have or had some.
std::vector<Coord> MeshExtractor::Blocks::Remesh(
    const TsdfVolume& volume, const internal::LeafLookup& lookup,
    float min_weight, const std::vector<Coord>& origins) {
  const openvdb::math::Transform& transform =
      volume.grids().distance->transform();
  std::vector<std::unique_ptr<LeafMesh>> made(origins.size());
  tbb::parallel_for(std::size_t{0}, origins.size(), [&](std::size_t i) {
    if (!lookup.MayHaveSurface(origins[i])) return;
    auto mesh = std::make_unique<LeafMesh>();
    if (MakeVertices(lookup, origins[i], transform, min_weight, mesh.get())) {
      made[i] = std::move(mesh);
    }
  });
  std::vector<Coord> renewed;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const bool is_made = made[i] != nullptr;
    if (is_made) meshes[origins[i]] = std::move(made[i]);
    if (is_made || meshes.erase(origins[i]) > 0) renewed.push_back(origins[i]);
  }
  return renewed;
}

/// Makes the triangles of blocks anew; `origins` may name blocks that have no
/// mesh.
void MeshExtractor::Blocks::ConnectAnew(const std::vector<Coord>& origins) {
  tbb::parallel_for(std::size_t{0}, origins.size(), [&](std::size_t i) {
    const auto found = meshes.find(origins[i]);
    if (found == meshes.end()) return;
    internal::LeafMeshes around;
    for (int k = 0; k < 8; ++k) {
      around[k] = Find(origins[i].offsetBy(-kLeafSize * (k >> 2),
                                           -kLeafSize * ((k >> 1) & 1),
                                           -kLeafSize * (k & 1)));
    }
    found->second->triangles = MakeTriangles(around);
  });
}

/// Joins the meshes of all blocks into one.
TriangleMesh MeshExtractor::Blocks::Join(std::vector<int>* kept_from) {
  TriangleMesh mesh;
  kept_from->clear();
  for (auto& [origin, block] : meshes) {
    const int begin = static_cast<int>(mesh.vertices.size());
    const int count = static_cast<int>(block->vertices.size());
    for (int i = 0; i < count; ++i) {
      kept_from->push_back(block->begin < 0 ? -1 : block->begin + i);
    }
    block->begin = begin;
    mesh.vertices.insert(mesh.vertices.end(), block->vertices.begin(),
                         block->vertices.end());
    mesh.normals.insert(mesh.normals.end(), block->normals.begin(),
                        block->normals.end());
    mesh.colors.insert(mesh.colors.end(), block->colors.begin(),
                       block->colors.end());
  }
  for (const auto& [origin, block] : meshes) {
    int begins[8];
    for (int k = 0; k < 8; ++k) {
      const LeafMesh* before = Find(origin.offsetBy(-kLeafSize * (k >> 2),
                                                    -kLeafSize * ((k >> 1) & 1),
                                                    -kLeafSize * (k & 1)));
      begins[k] = before == nullptr ? 0 : before->begin;
    }
    for (const auto& triangle : block->triangles) {
      Eigen::Vector3i& joined = mesh.triangles.emplace_back();
      for (int k = 0; k < 3; ++k) {
        joined[k] = begins[triangle[k].block] + triangle[k].vertex;
      }
    }
  }
  return mesh;
}

MeshExtractor::MeshExtractor() : blocks_(std::make_unique<Blocks>()) {}
MeshExtractor::~MeshExtractor() = default;
MeshExtractor::MeshExtractor(MeshExtractor&&) noexcept = default;
MeshExtractor& MeshExtractor::operator=(MeshExtractor&&) noexcept = default;

TriangleMesh MeshExtractor::Extract(const TsdfVolume& volume,
                                    double min_weight) {
  static_assert(kMaxMinWeight <= internal::kFirmWeight);
  const bool again = blocks_->time >= 0;
  CheckOption(!again || min_weight <= kMaxMinWeight, "min_weight", min_weight,
              "at most 8 where a volume is meshed again");
  const internal::LeafLookup lookup(volume);
  // The mesh of a block reaches into its neighbours, and the faces around its
  // lowest voxels have corners in the blocks before it.
  const std::vector<Coord> renewed =
      blocks_->Remesh(volume, lookup, static_cast<float>(min_weight),
                      WithNeighbors(blocks_->Changed(volume), -1, 1));
  blocks_->ConnectAnew(WithNeighbors(renewed, 0, 1));
  blocks_->time = volume.grids().time;
  return blocks_->Join(&kept_from_);
}

TriangleMesh ExtractMesh(const TsdfVolume& volume, double min_weight) {
  return MeshExtractor().Extract(volume, min_weight);
}

}  // namespace splitfusion
