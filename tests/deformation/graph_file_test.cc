#include "splitfusion/lib/deformation/graph_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "splitfusion/lib/base/error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;

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
  WriteGraph(folder / "graph.json", graph, 4);
  const DeformationGraph read = ReadGraph(folder / "graph.json", nullptr);
  EXPECT_EQ(read.first_seen, graph.first_seen);
}

TEST(Graph, KeepsWhereItsPartsBeginAndEnd) {
  const TemporaryFolder folder;
  DeformationGraph graph = Triangle();
  graph.parts = {{0, 2, 7}, {1, 7}};
  const std::string path = folder / "graph.json";
  WriteGraph(path, graph, 4);
  const DeformationGraph read = ReadGraph(path, nullptr);
  ASSERT_EQ(read.parts.size(), 2u);
  EXPECT_EQ(read.parts[0].end_frame, 7);
  EXPECT_EQ(read.parts[1].node, 1);
  EXPECT_EQ(read.parts[1].first_frame, 7);
  EXPECT_EQ(read.parts[1].end_frame, ModelPart::kNoEnd);
  for (const char* wrong :
       {"7", "[3]", "[[0, 2]]", "[[1, 2, null]]", "[[0, 2, 3], [0, 3, null]]",
        "[[0, 2, 2]]", "[[0, 0, null], [9, 1, null]]", "[[0, -1, null]]",
        "[[0, 1, \"end\"]]"}) {
    folder.Write("graph.json",
                 R"({"node_spacing": 1, "positions": [[1, 2, 3], [1, 2, 4]],
                     "edges": [[], []], "parts": )" +
                     std::string(wrong) + "}");
    EXPECT_THAT(GraphMessage(path), HasSubstr("field 'parts'")) << wrong;
  }
  folder.Write("graph.json",
               R"({"node_spacing": 1, "positions": [[1, 2, 3], [1, 2, 4]],
                   "edges": [[], []], "models": [[0, 0], [1, 4]]})");
  EXPECT_THAT(GraphMessage(path), HasSubstr("field 'models': expected a run"));
}

TEST(Graph, MayLackFirstSights) {
  const TemporaryFolder folder;
  folder.Write("graph.json", R"({"node_spacing": 1, "positions": [[1, 2, 3]],
                                 "edges": [[]]})");
  EXPECT_TRUE(ReadGraph(folder / "graph.json", nullptr).first_seen.empty());
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

TEST(Graph, DeepOnesAreRefusedNotFollowed) {
  const TemporaryFolder folder;
  const std::string deep =
      std::string(100000, '[') + "{}" + std::string(100000, ']');
  const std::string path = folder.Write(
      "graph.json",
      R"({"node_spacing": 1, "positions": [[1, 2, 3]], "edges": [[]],
          "first_seen": {"a": )" +
          deep + "}}");
  EXPECT_THAT(GraphMessage(path), HasSubstr("field 'first_seen'"));
}

}  // namespace
}  // namespace splitfusion
