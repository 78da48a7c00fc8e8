#include "splitfusion/lib/deformation/motion_log.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <sstream>
#include <vector>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/deformation/graph_growth.h"
#include "splitfusion/lib/deformation/mesh_skinning.h"
#include "splitfusion/lib/deformation/node_births.h"
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
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    const FrameMotions& one = a.frames[f];
    const FrameMotions& other = b.frames[f];
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
  EXPECT_EQ(static_cast<int>(all.frames.front().motions.size()),
            kept.graph.size());
  ExpectSame(all, spooled.log.All());
}

TEST(MotionLog, FindsFrames) {
  const SlidingPlate plate(kLittle);
  const MotionHistory all = plate.log.All();
  for (const int i : {0, 1, kFrames / 2, kFrames - 1}) {
    EXPECT_EQ(plate.log.frame(i), 2 * i);
    EXPECT_EQ(plate.log.tracked(i), i % 5 != 0);
    ExpectSame({{plate.log.Find(2 * i).value()}}, {{all.frames[i]}});
  }
  EXPECT_FALSE(plate.log.Find(-1).has_value());
  EXPECT_FALSE(plate.log.Find(5).has_value());
  EXPECT_FALSE(plate.log.Find(2 * kFrames).has_value());
  EXPECT_FALSE(MotionLog().Find(0).has_value());
}

TEST(MotionLog, APartIsSomeNodesFromAFrameOn) {
  SlidingPlate kept(kMuch), spooled(kLittle);
  std::vector<char> nodes(kept.graph.size(), false);
  std::vector<int> chosen;
  for (int i = 3; i < kept.graph.size(); i += 4) {
    nodes[i] = true;
    chosen.push_back(i);
  }
  const int first = 2 * 37;  // Amid a block.
  const MotionLog part = spooled.log.Part(nodes, first);
  const MotionHistory all = kept.log.All();
  ASSERT_EQ(part.size(), kFrames - 37);
  for (int i = 0; i < part.size(); ++i) {
    const FrameMotions& whole = all.frames[37 + i];
    const FrameMotions frame = part.At(i);
    EXPECT_EQ(frame.frame, whole.frame);
    ASSERT_EQ(frame.motions.size(), chosen.size());
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      EXPECT_EQ(frame.motions[k].rotation, whole.motions[chosen[k]].rotation);
      EXPECT_EQ(frame.Saw(static_cast<int>(k)), whole.Saw(chosen[k]));
    }
  }
  ExpectSame(part.All(), kept.log.Part(nodes, first).All());
  // It stays as it is when the rest goes on.
  const MotionHistory before = part.All();
  for (int frame = kFrames; frame < kFrames + 40; ++frame) spooled.Track(frame);
  ExpectSame(part.All(), before);
  EXPECT_TRUE(
      spooled.log.Part(std::vector<char>(spooled.graph.size(), true), 1000)
          .empty());
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
  // each must not be what is known of the whole.
  SlidingPlate plate(kLittle);
  std::vector<char> nodes(plate.graph.size(), true);
  const std::size_t whole = IndexBytes(plate.log.Part(nodes, 0));
  nodes.assign(nodes.size(), false);
  nodes[0] = true;
  const MotionLog part = plate.log.Part(nodes, 0);
  ASSERT_EQ(part.size(), kFrames);
  constexpr std::size_t kHeads = std::size_t{kFrames} * 64;
  EXPECT_LT(IndexBytes(part), kHeads);
  EXPECT_GT(whole, 2 * kHeads);
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
