#include "splitfusion/lib/deformation/motion_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "splitfusion/lib/base/error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;

NodeMotion Motion(double value) {
  NodeMotion motion;
  motion.rotation = ExpSo3({value, -0.5 * value, 2 * value});
  motion.translation = Eigen::Vector3d(value, 2, -3);
  return motion;
}

MotionHistory TwoFrames() {
  MotionHistory history;
  history.frames.push_back({3, true, {Motion(0.1), Motion(0.2)}});
  history.frames.push_back({5, false, {Motion(0.3), Motion(0.4)}});
  return history;
}

DeformationGraph Triangle() {
  DeformationGraph graph;
  graph.node_spacing = 0.025;
  graph.positions = {{0.1, 0.2, 1.0 / 3}, {1, 2, 3}, {-1e-9, 0, 7}};
  graph.neighbors = {{1, 2}, {0}, {}};
  graph.motions.resize(3);
  return graph;
}

std::string GraphMessage(const std::string& path) {
  try {
    ReadGraph(path, nullptr);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(MotionHistory, FindsFrames) {
  const MotionHistory history = TwoFrames();
  ASSERT_NE(history.Find(5), nullptr);
  EXPECT_FALSE(history.Find(5)->tracked);
  EXPECT_EQ(history.Find(4), nullptr);
  EXPECT_EQ(history.Find(6), nullptr);
  EXPECT_EQ(MotionHistory().Find(0), nullptr);
}

TEST(Motions, RoundTripInFloat) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", TwoFrames());
  const MotionHistory read = ReadMotions(folder / "motions.bin");
  ASSERT_EQ(read.frames.size(), 2u);
  EXPECT_EQ(read.frames[0].frame, 3);
  EXPECT_TRUE(read.frames[0].tracked);
  EXPECT_FALSE(read.frames[1].tracked);
  const NodeMotion expected = Motion(0.4);
  const NodeMotion& motion = read.frames[1].motions[1];
  EXPECT_TRUE(motion.rotation.isApprox(expected.rotation, 1e-6));
  EXPECT_TRUE(motion.translation.isApprox(expected.translation, 1e-6));
}

TEST(Motions, HaveTheDocumentedLayout) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", TwoFrames());
  const std::string bytes = folder.Read("motions.bin");
  EXPECT_EQ(bytes.size(), 8 + 8 + 2 * (8 + 2 * 48));
  EXPECT_EQ(bytes.substr(0, 8), "SFMOTN01");
  float translation_y = 0;
  bytes.copy(reinterpret_cast<char*>(&translation_y), 4, 24 + 10 * 4);
  EXPECT_EQ(translation_y, 2);
}

TEST(Motions, OfNoFrameAreFine) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", {});
  EXPECT_TRUE(ReadMotions(folder / "motions.bin").frames.empty());
}

TEST(Motions, RejectTruncatedAndForeignFiles) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", TwoFrames());
  const std::string bytes = folder.Read("motions.bin");
  for (const std::string& broken :
       {bytes.substr(0, bytes.size() - 1), bytes + "x", bytes.substr(0, 11),
        std::string("something else"), std::string()}) {
    folder.Write("broken.bin", broken);
    EXPECT_THROW(ReadMotions(folder / "broken.bin"), InputError);
  }
  EXPECT_THROW(ReadMotions(folder / "none.bin"), InputError);
}

TEST(Graph, RoundTripIsExact) {
  const TemporaryFolder folder;
  WriteGraph(folder / "graph.json", Triangle(), 4);
  int neighbors_per_point = 0;
  const DeformationGraph read =
      ReadGraph(folder / "graph.json", &neighbors_per_point);
  EXPECT_EQ(neighbors_per_point, 4);
  EXPECT_EQ(read.positions, Triangle().positions);
  EXPECT_EQ(read.neighbors, Triangle().neighbors);
  EXPECT_EQ(read.node_spacing, 0.025);
  EXPECT_TRUE(read.first_seen.empty());
  ASSERT_EQ(read.motions.size(), 3u);
  EXPECT_TRUE(read.motions[2].rotation.isIdentity());
}

TEST(Graph, KeepsFirstSights) {
  const TemporaryFolder folder;
  DeformationGraph graph = Triangle();
  graph.first_seen = {2, 2, 5};
  graph.sightings = {{{2, 4}}, {{2, 2}, {6, 9}}, {{5, 5}}};
  WriteGraph(folder / "graph.json", graph, 4);
  const DeformationGraph read = ReadGraph(folder / "graph.json", nullptr);
  EXPECT_EQ(read.first_seen, graph.first_seen);
  ASSERT_EQ(read.sightings.size(), 3u);
  ASSERT_EQ(read.sightings[1].size(), 2u);
  EXPECT_EQ(read.sightings[0][0].first, 2);
  EXPECT_EQ(read.sightings[0][0].last, 4);
  EXPECT_EQ(read.sightings[1][1].first, 6);
  EXPECT_EQ(read.sightings[1][1].last, 9);
}

TEST(Graph, MayLackFirstSights) {
  const TemporaryFolder folder;
  folder.Write("graph.json", R"({"node_spacing": 1, "positions": [[1, 2, 3]],
                                 "edges": [[]]})");
  EXPECT_TRUE(ReadGraph(folder / "graph.json", nullptr).first_seen.empty());
}

TEST(Graph, SightingsAreRunsOfFrames) {
  const TemporaryFolder folder;
  const std::string path = folder / "graph.json";
  const std::string head =
      R"({"node_spacing": 1, "positions": [[1, 2, 3]], "edges": [[]], )";
  folder.Write("graph.json", head + R"("sightings": [[3, 4], [5, 6]]})");
  EXPECT_THAT(GraphMessage(path), HasSubstr("'sightings' has 2 entries"));
  for (const char* wrong :
       {"3", "null", "[]", "[3]", "[4, 3]", "[3, 4, 4]", "[5, 6, 1, 2]",
        "[-1, 2]", "[1, null]", "\"3\"", R"({"a": 1, "b": 2})"}) {
    folder.Write("graph.json",
                 head + R"("sightings": [)" + std::string(wrong) + "]}");
    EXPECT_THAT(GraphMessage(path), HasSubstr("field 'sightings'")) << wrong;
  }
  folder.Write("graph.json", head + R"("sightings": 7})");
  EXPECT_THAT(GraphMessage(path), HasSubstr("expected an array"));
}

TEST(Graph, NamesTheBadField) {
  const TemporaryFolder folder;
  const std::string path = folder / "graph.json";
  EXPECT_THAT(GraphMessage(path), HasSubstr("cannot be opened"));
  folder.Write("graph.json", "[1, 2");
  EXPECT_THAT(GraphMessage(path), HasSubstr("expected a JSON object"));
  folder.Write("graph.json", R"({"node_spacing": "wide"})");
  EXPECT_THAT(GraphMessage(path), HasSubstr("field 'node_spacing'"));
  folder.Write("graph.json", R"({"node_spacing": 1, "positions": [[1, 2]]})");
  EXPECT_THAT(GraphMessage(path), HasSubstr("field 'positions'"));
  const std::string head = R"({"node_spacing": 1, "positions": [[1, 2, 3]], )";
  folder.Write("graph.json", head + R"("edges": [[], []]})");
  EXPECT_THAT(GraphMessage(path), HasSubstr("'edges' has 2 entries"));
  folder.Write("graph.json", head + R"("edges": [[1]]})");
  EXPECT_THAT(GraphMessage(path), HasSubstr("names node 1: expected 0..0"));
  folder.Write("graph.json", head + R"("edges": [[]], "first_seen": [1, 2]})");
  EXPECT_THAT(GraphMessage(path), HasSubstr("'first_seen' has 2 entries"));
  for (const char* wrong : {"\"early\"", "-1", "2.7", "true", "null", "1e20",
                            "2147483648", "4294967299"}) {
    folder.Write("graph.json",
                 head + R"("edges": [[]], "first_seen": [)" + wrong + "]}");
    EXPECT_THAT(GraphMessage(path), HasSubstr("field 'first_seen'")) << wrong;
  }
  folder.Write("graph.json",
               R"({"node_spacing": 1, "positions": [[1, 2, 1e39]],
                   "edges": [[]]})");
  EXPECT_THAT(GraphMessage(path), HasSubstr("field 'positions'"));
  folder.Write("graph.json",
               R"({"node_spacing": -1, "positions": [[1, 2, 3]],
                   "edges": [[]]})");
  EXPECT_THAT(GraphMessage(path), HasSubstr("field 'node_spacing'"));
  folder.Write("graph.json", head + R"("edges": [[]]})");
  int neighbors = 0;
  EXPECT_THROW(ReadGraph(path, &neighbors), InputError);
}

}  // namespace
}  // namespace splitfusion
