#include "splitfusion/lib/deformation/motion_log.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <sstream>
#include <vector>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/base/chosen.h"
#include "splitfusion/lib/deformation/graph_growth.h"
#include "splitfusion/lib/deformation/mesh_skinning.h"
#include "splitfusion/lib/deformation/node_births.h"
#include "support/motion_frames.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// Bytes that hold some frames only, and ones that hold all.
constexpr std::size_t kLittle = 100000;
constexpr std::size_t kMuch = std::size_t{1} << 30;
/// Frames of the plate below.
constexpr int kFrames = 90;

/// A plate that is tracked while it slides under the camera: every few frames
/// nodes are born at one end and forgotten at the other.
struct SlidingPlate {
  explicit SlidingPlate(std::size_t memory)
      : log(std::make_shared<SpoolFile>(), memory) {
    graph = CoverWithNodes(mesh, 0.04);
    for (int frame = 0; frame < kFrames; ++frame) Track(frame);
  }

  void Track(int frame) {
    Shake(0.002, /*seed=*/frame, &graph);
    std::vector<char> seen(graph.size());
    for (int i = 0; i < graph.size(); ++i) seen[i] = (i + frame) % 3 != 0;
    // What was seen of a frame is not always known.
    if (frame % 7 == 0) seen.clear();
    log.Append({2 * frame, frame % 5 != 0, graph.motions, seen});
    graph.first_seen.resize(graph.size(), 2 * frame);
    if (frame % 3 != 0) return;
    for (Eigen::Vector3f& v : mesh.vertices) v.x() += 0.02f;
    const SkinningIndex index(graph, 6);
    const NodeChange change =
        UpdateGraph(mesh, GraphOptions(), index,
                    MeshSkinning(index, mesh.vertices), &graph, &record, &log);
    born += change.added;
    forgotten += change.forgotten();
  }

  TriangleMesh mesh = PlateMesh(0.4, 0.3, 0.02, 1);
  DeformationGraph graph;
  GraphRecord record{0.04, {}};
  MotionLog log;
  int born = 0;
  int forgotten = 0;
};

void ExpectSame(const MotionHistory& a, const MotionHistory& b) {
  ASSERT_EQ(a.size(), b.size());
  for (int f = 0; f < a.size(); ++f) {
    const FrameMotions one = a.At(f);
    const FrameMotions other = b.At(f);
    EXPECT_EQ(one.frame, other.frame);
    EXPECT_EQ(one.tracked, other.tracked) << one.frame;
    EXPECT_EQ(one.seen, other.seen) << one.frame;
    ASSERT_EQ(one.motions.size(), other.motions.size()) << one.frame;
    EXPECT_EQ(std::memcmp(one.motions.data(), other.motions.data(),
                          one.motions.size() * sizeof(NodeMotion)),
              0)
        << one.frame;
  }
}

TEST(MotionLog, FramesInTheFileAreAsIfTheyHadStayedInMemory) {
  const SlidingPlate kept(kMuch), spooled(kLittle);
  ASSERT_GT(kept.born, 50);
  ASSERT_GT(kept.forgotten, 50);
  ASSERT_EQ(kept.log.size(), kFrames);
  const MotionHistory all = kept.log.All();
  EXPECT_EQ(static_cast<int>(all.At(0).motions.size()), kept.graph.size());
  ExpectSame(all, spooled.log.All());
}

TEST(MotionLog, FindsFrames) {
  const SlidingPlate plate(kLittle);
  const MotionHistory all = plate.log.All();
  for (const int i : {0, 1, kFrames / 2, kFrames - 1}) {
    EXPECT_EQ(plate.log.frame(i), 2 * i);
    EXPECT_EQ(plate.log.tracked(i), i % 5 != 0);
    ExpectSame(HistoryOf({plate.log.Find(2 * i).value()}),
               HistoryOf({all.At(i)}));
  }
  EXPECT_FALSE(plate.log.Find(-1).has_value());
  EXPECT_FALSE(plate.log.Find(5).has_value());
  EXPECT_FALSE(plate.log.Find(2 * kFrames).has_value());
  EXPECT_FALSE(MotionLog().Find(0).has_value());
}

/// Some nodes of a graph, and the graph of these alone.
struct Some {
  Some(const DeformationGraph& graph, int step, int first_frame) {
    for (int i = 0; i < graph.size(); ++i) {
      const bool is = i % step == 0 && graph.first_seen[i] >= first_frame;
      nodes.push_back(is);
      if (is) indices.push_back(i);
    }
    part.positions = Chosen(graph.positions, nodes);
    part.first_seen = Chosen(graph.first_seen, nodes);
  }

  /// The one that is nearest to node k of them, of those seen before it.
  int Nearest(int k) const {
    int nearest = 0;
    const auto distance = [&](int i) {
      return (part.positions[i] - part.positions[k]).norm();
    };
    for (int i = 0; part.first_seen[i] < part.first_seen[k]; ++i) {
      if (distance(i) < distance(nearest)) nearest = i;
    }
    return nearest;
  }

  std::vector<char> nodes;
  std::vector<int> indices;
  DeformationGraph part;
};

TEST(MotionLog, APartIsSomeNodesFromTheFirstSightOfTheirsOn) {
  SlidingPlate kept(kMuch), spooled(kLittle);
  const Some some(spooled.graph, 4, 2 * 37);
  const int first = some.part.first_seen.front();
  ASSERT_LT(first, some.part.first_seen.back());
  const MotionLog part = spooled.log.Part(some.nodes, some.part);
  const MotionHistory all = kept.log.All();
  ASSERT_EQ(part.size(), kFrames - first / 2);
  for (int i = 0; i < part.size(); ++i) {
    const FrameMotions whole = all.At(first / 2 + i);
    const FrameMotions frame = part.At(i);
    EXPECT_EQ(frame.frame, whole.frame);
    ASSERT_EQ(frame.motions.size(), some.indices.size());
    for (std::size_t k = 0; k < some.indices.size(); ++k) {
      if (some.part.first_seen[k] > frame.frame) continue;
      const int node = some.indices[k];
      EXPECT_EQ(frame.motions[k].rotation, whole.motions[node].rotation);
      EXPECT_EQ(frame.Saw(static_cast<int>(k)), whole.Saw(node));
    }
  }
  ExpectSame(part.All(), kept.log.Part(some.nodes, some.part).All());
  // It stays as it is when the rest goes on.
  const MotionHistory before = part.All();
  for (int frame = kFrames; frame < kFrames + 40; ++frame) spooled.Track(frame);
  ExpectSame(part.All(), before);
}

TEST(MotionLog, NodesOfAPartMoveWithItsOwnBeforeTheyWereSeen) {
  for (const std::size_t memory : {kMuch, kLittle}) {
    SlidingPlate plate(memory);
    const Some some(plate.graph, 3, 20);
    const MotionLog part = plate.log.Part(some.nodes, some.part);
    int before = 0;
    for (int i = 0; i < part.size(); ++i) {
      const FrameMotions frame = part.At(i);
      for (int k = 0; k < some.part.size(); ++k) {
        if (some.part.first_seen[k] <= frame.frame) continue;
        const int nearest = some.Nearest(k);
        // Eq. 1 by that node alone.
        EXPECT_LT((frame.motions[k].rotation - frame.motions[nearest].rotation)
                      .norm(),
                  1e-6);
        EXPECT_FALSE(frame.Saw(k));
        ++before;
      }
    }
    EXPECT_GT(before, 100);
  }
}

TEST(MotionLog, APartOfNothingIsEmpty) {
  const SlidingPlate plate(kLittle);
  const std::vector<char> none(plate.graph.size(), false);
  EXPECT_TRUE(plate.log.Part(none, DeformationGraph()).empty());
  EXPECT_TRUE(MotionLog().Part({}, DeformationGraph()).empty());
}

/// Bytes of all that is known of a complete log beside its motions.
std::size_t IndexBytes(MotionLog log) {
  std::stringstream stream;
  ArchiveWriter writer(&stream);
  log.SerializeIndex(&writer);
  writer.Flush();
  return stream.str().size();
}

TEST(MotionLog, APartKnowsOfItsOwnNodesAlone) {
  // Thousands of parts of a long recording lie in the file: what is known of
  // each must not grow with what is known of the whole.
  SlidingPlate plate(kLittle);
  for (int frame = kFrames; frame < 3 * kFrames; ++frame) plate.Track(frame);
  const Some late(plate.graph, 1, 4 * kFrames);
  ASSERT_GT(late.part.size(), 20);
  ASSERT_LT(late.part.first_seen.front(), late.part.first_seen.back());
  const MotionLog part = plate.log.Part(late.nodes, late.part);
  EXPECT_LE(part.size(), kFrames);
  // Of every block of 16 frames: heads, and an index or two of every node.
  const int blocks = part.size() / 16 + 2;
  const std::size_t bound =
      blocks * (16 * 20 + late.part.size() * 12 + 100) + late.part.size() * 200;
  EXPECT_LT(IndexBytes(part), bound);
}

TEST(MotionLog, IsRestoredAndGoesOnAsBefore) {
  SlidingPlate plate(kLittle);
  std::stringstream stream;
  ArchiveWriter writer(&stream);
  writer(plate.log);
  writer.Flush();
  SlidingPlate other(kLittle);
  other.log = MotionLog(std::make_shared<SpoolFile>(), kLittle);
  ArchiveReader reader(&stream, stream.str().size(), "state");
  reader(other.log);
  ExpectSame(other.log.All(), plate.log.All());
  for (int frame = kFrames; frame < kFrames + 20; ++frame) {
    plate.Track(frame);
    other.Track(frame);
  }
  ExpectSame(other.log.All(), plate.log.All());
}

TEST(MotionLog, MotionsOfARigidSurfaceCanBeReplaced) {
  MotionLog log(std::make_shared<SpoolFile>(), /*memory=*/1000);
  NodeMotion motion;
  for (int frame = 0; frame < 60; ++frame) {
    motion.translation.x() = frame;
    log.Append({frame, true, {motion}, {1}});
  }
  motion.translation.x() = 0.5;
  for (const int i : {0, 20, 59}) log.Replace(i, {motion});
  for (const int i : {0, 1, 20, 21, 59}) {
    const bool replaced = i == 0 || i == 20 || i == 59;
    EXPECT_EQ(log.At(i).motions[0].translation.x(), replaced ? 0.5 : i);
    EXPECT_TRUE(log.At(i).Saw(0)) << i;
  }
}

TEST(MotionLog, GrowthBeforeTheFirstFrameChangesNothing) {
  SlidingPlate plate(kMuch);
  MotionLog log;
  log.Grow(NodeBirths(), NodeChange::None(3));
  log.Append({4, true, plate.graph.motions, {}});
  EXPECT_EQ(log.At(0).motions.size(), plate.graph.motions.size());
  EXPECT_TRUE(log.At(0).seen.empty());
}

}  // namespace
}  // namespace splitfusion
