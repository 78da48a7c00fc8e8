#include "splitfusion/lib/deformation/motion_history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>

#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/deformation/motion_file.h"
#include "support/expect_input_error.h"
#include "support/motion_frames.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

NodeMotion Motion(double value) {
  NodeMotion motion;
  motion.rotation = ExpSo3({value, -0.5 * value, 2 * value});
  motion.translation = Eigen::Vector3d(value, 2, -3);
  return motion;
}

MotionHistory TwoFrames() {
  MotionHistory history;
  history.Append({3, true, {Motion(0.1), Motion(0.2)}, {0, 1}});
  history.Append({5, false, {Motion(0.3), Motion(0.4)}});
  return history;
}

TEST(MotionHistory, FindsFrames) {
  const MotionHistory history = TwoFrames();
  ASSERT_TRUE(history.Find(5).has_value());
  EXPECT_FALSE(history.Find(5)->tracked);
  EXPECT_FALSE(history.Find(4).has_value());
  EXPECT_FALSE(history.Find(6).has_value());
  EXPECT_TRUE(history.Has(3));
  EXPECT_FALSE(history.Has(6));
  EXPECT_FALSE(MotionHistory().Find(0).has_value());
}

TEST(MotionHistory, FramesInItsFileAreAsInMemory) {
  std::vector<FrameMotions> frames;
  for (int f = 0; f < 9; ++f) {
    frames.push_back({2 * f,
                      f % 3 != 0,
                      {Motion(0.1 * f), Motion(0.2)},
                      {0, static_cast<char>(f % 2)},
                      {{0, 1}, {3, 4}}});
  }
  const MotionHistory kept = HistoryOf(frames);
  // Of nine, two fit.
  MotionHistory spooled = HistoryOf(frames, 2 * frames[0].bytes());
  const MotionHistory copy = spooled;
  for (const int i : {0, 5, 5, 8}) {
    EditFrame(
        i, [&](FrameMotions& frame) { frame.motions[1] = Motion(i); },
        &spooled);
  }
  ASSERT_EQ(spooled.size(), 9);
  for (int i = 0; i < 9; ++i) {
    const FrameMotions a = kept.At(i), b = copy.At(i);
    EXPECT_EQ(b.frame, 2 * i);
    EXPECT_EQ(a.tracked, b.tracked);
    EXPECT_EQ(a.seen, b.seen);
    EXPECT_EQ(b.IndexOf(3), 1);
    EXPECT_EQ(a.motions[0].rotation, b.motions[0].rotation);
    EXPECT_EQ(a.motions[1].rotation, b.motions[1].rotation) << "a copy of it";
    const bool edited = i == 0 || i == 5 || i == 8;
    EXPECT_EQ(spooled.At(i).motions[1].rotation,
              edited ? Motion(i).rotation : Motion(0.2).rotation);
  }
}

TEST(Motions, RoundTripInFloat) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", TwoFrames(), 2);
  const MotionHistory read = ReadMotions(folder / "motions.bin");
  ASSERT_EQ(read.size(), 2);
  EXPECT_EQ(read.frame(0), 3);
  EXPECT_TRUE(read.At(0).tracked);
  EXPECT_FALSE(read.At(1).tracked);
  const NodeMotion expected = Motion(0.4);
  const NodeMotion motion = read.At(1).motions[1];
  EXPECT_TRUE(motion.rotation.isApprox(expected.rotation, 1e-6));
  EXPECT_TRUE(motion.translation.isApprox(expected.translation, 1e-6));
  EXPECT_FALSE(read.At(0).Saw(0));
  EXPECT_TRUE(read.At(0).Saw(1));
  EXPECT_FALSE(read.At(1).Saw(1)) << "not known";
}

TEST(Motions, HaveTheDocumentedLayout) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", TwoFrames(), 2);
  const std::string bytes = folder.Read("motions.bin");
  ASSERT_EQ(bytes.size(), 8 + 8 + 2 * (12 + 8 + 2 * 49) + 8);
  EXPECT_EQ(bytes.substr(0, 8), "SFMOTN04");
  EXPECT_EQ(bytes.substr(24, 12), std::string("\1\0\0\0\0\0\0\0\2\0\0\0", 12));
  std::uint64_t checksum = 0;
  bytes.copy(reinterpret_cast<char*>(&checksum), 8, bytes.size() - 8);
  EXPECT_EQ(checksum, Checksum64(bytes.data(), bytes.size() - 8));
  float translation_y = 0;
  bytes.copy(reinterpret_cast<char*>(&translation_y), 4, 36 + 10 * 4);
  EXPECT_EQ(translation_y, 2);
  EXPECT_EQ(bytes.substr(36 + 2 * 48, 2), std::string("\0\1", 2));
}

/// Three nodes, of which the first two are in use in frame 3, the last one,
/// too, in frame 4, and that alone in frame 5.
MotionHistory SomeInUse() {
  MotionHistory history;
  history.Append({3, true, {Motion(0.1), Motion(0.2)}, {0, 1}, {{0, 2}}});
  history.Append({4, true, {Motion(0.3), Motion(0.4), Motion(0.5)}, {1, 0, 1}});
  history.Append({5, true, {Motion(0.6)}, {1}, {{2, 3}}});
  return history;
}

TEST(FrameMotions, KnowOfWhichNodesTheyAre) {
  const MotionHistory history = SomeInUse();
  const FrameMotions last = history.At(2);
  EXPECT_EQ(last.IndexOf(1), -1);
  EXPECT_EQ(last.IndexOf(2), 0);
  EXPECT_EQ(last.IndexOf(3), -1);
  EXPECT_FALSE(last.Saw(0));
  EXPECT_TRUE(last.Saw(2));
  EXPECT_EQ(last.Of(2).translation, Motion(0.6).translation);
  EXPECT_EQ(history.At(1).IndexOf(2), 2);
  EXPECT_EQ(history.At(1).IndexOf(3), -1);
  const FrameMotions apart = {
      0, true, {Motion(1), Motion(2)}, {}, {{1, 2}, {4, 5}}};
  EXPECT_EQ(apart.IndexOf(4), 1);
  EXPECT_EQ(apart.IndexOf(3), -1);
  std::vector<NodeMotion> all(5);
  apart.SpreadTo(&all);
  EXPECT_TRUE(all[0].rotation.isIdentity(0));
  EXPECT_EQ(all[1].rotation, Motion(1).rotation);
  EXPECT_TRUE(all[2].rotation.isIdentity(0));
  EXPECT_EQ(all[4].rotation, Motion(2).rotation);
}

TEST(MotionsOfAll, AreTheNearestOfNodesThatAreNotInUse) {
  DeformationGraph graph;
  graph.positions.resize(3);
  graph.parts = {{0, 3, 5}, {2, 4}};
  const auto turned_by = [&](int frame, int node) {
    const MotionHistory history = SomeInUse();
    return MotionsOfAll(history, graph, EndsOfParts(history, graph),
                        frame)[node]
        .rotation;
  };
  EXPECT_EQ(turned_by(3, 1), Motion(0.2).rotation);
  EXPECT_EQ(turned_by(3, 2), Motion(0.5).rotation) << "of frame 4";
  EXPECT_EQ(turned_by(4, 2), Motion(0.5).rotation);
  EXPECT_EQ(turned_by(5, 2), Motion(0.6).rotation);
  EXPECT_EQ(turned_by(5, 0), Motion(0.3).rotation) << "of frame 4";
  EXPECT_EQ(turned_by(5, 1), Motion(0.4).rotation);
}

TEST(Motions, OfNodesInUseSurviveWritingAndReading) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", SomeInUse(), 3);
  int nodes = 0;
  const MotionHistory read = ReadMotions(folder / "motions.bin", &nodes);
  EXPECT_EQ(nodes, 3);
  ASSERT_EQ(read.size(), 3);
  EXPECT_EQ(read.At(0).motions.size(), 2u);
  EXPECT_EQ(read.At(0).IndexOf(2), -1);
  EXPECT_TRUE(read.At(1).ranges.empty());
  EXPECT_TRUE(read.At(2).Saw(2));
  EXPECT_TRUE(read.At(2).Of(2).rotation.isApprox(Motion(0.6).rotation, 1e-6));
  EXPECT_EQ(folder.Read("motions.bin").size(),
            16 + 3 * 20 + (2 + 3 + 1) * 49 + 8);
}

TEST(Motions, ThatAreDamagedAreNamedByTheirNode) {
  const TemporaryFolder folder;
  MotionHistory history = SomeInUse();
  EditFrame(
      2, [](FrameMotions& frame) { frame.motions[0].rotation *= -1; },
      &history);
  WriteMotions(folder / "motions.bin", history, 3);
  ExpectInputError([&] { ReadMotions(folder / "motions.bin"); },
                   "frame 5, node 2: its motion is no rotation");
}

TEST(Motions, OfNodesThatCannotBeAreRefused) {
  const TemporaryFolder folder;
  for (const std::vector<NodeRange>& ranges :
       std::vector<std::vector<NodeRange>>{
           {{1, 3}}, {{1, 2}, {0, 1}}, {{0, 1}, {0, 1}}}) {
    MotionHistory history = TwoFrames();
    EditFrame(
        0, [&](FrameMotions& frame) { frame.ranges = ranges; }, &history);
    WriteMotions(folder / "motions.bin", history, 2);
    ExpectInputError([&] { ReadMotions(folder / "motions.bin"); },
                     "expected ascending ones of 2");
  }
}

TEST(Motions, OfNoFrameAreFine) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", {}, 0);
  EXPECT_TRUE(ReadMotions(folder / "motions.bin").empty());
}

TEST(Motions, RejectTruncatedAndForeignFiles) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", TwoFrames(), 2);
  const std::string bytes = folder.Read("motions.bin");
  for (const std::string& broken :
       {bytes.substr(0, bytes.size() - 1), bytes + "x", bytes.substr(0, 11),
        std::string("something else"), std::string()}) {
    folder.Write("broken.bin", broken);
    EXPECT_THROW(ReadMotions(folder / "broken.bin"), InputError);
  }
  EXPECT_THROW(ReadMotions(folder / "none.bin"), InputError);
}

TEST(Motions, EveryChangedByteIsNoticed) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", TwoFrames(), 2);
  const std::string bytes = folder.Read("motions.bin");
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const int change : {0x01, 0x03, 0x80, 0xff}) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      folder.Write("damaged.bin", damaged);
      EXPECT_THROW(ReadMotions(folder / "damaged.bin"), InputError)
          << "byte " << at;
    }
  }
}

/// The file of TwoFrames() as an older version had it: without ranges of nodes;
/// in 01 and 02 without what was seen, in 01 without a checksum.
std::string OfVersion(char version, std::string bytes) {
  constexpr std::size_t kHead = 16, kIndex = 8, kRanges = 12, kSeen = 2;
  constexpr std::size_t kFrame = kIndex + kRanges + 2 * 48 + kSeen;
  bytes.resize(bytes.size() - 8);
  for (const std::size_t frame : {kHead + kFrame, kHead}) {
    if (version < '3') bytes.erase(frame + kFrame - kSeen, kSeen);
    bytes.erase(frame + kIndex, kRanges);
  }
  bytes[7] = version;
  if (version == '1') return bytes;
  const std::uint64_t checksum = Checksum64(bytes.data(), bytes.size());
  return bytes.append(reinterpret_cast<const char*>(&checksum), 8);
}

TEST(Motions, OfOlderVersionsAreRead) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", TwoFrames(), 2);
  const std::string bytes = folder.Read("motions.bin");
  for (const char version : {'1', '2', '3'}) {
    folder.Write("old.bin", OfVersion(version, bytes));
    const MotionHistory read = ReadMotions(folder / "old.bin");
    ASSERT_EQ(read.size(), 2);
    EXPECT_TRUE(
        read.At(1).motions[1].rotation.isApprox(Motion(0.4).rotation, 1e-6));
    EXPECT_EQ(read.At(0).seen,
              version < '3' ? std::vector<char>() : std::vector<char>({0, 1}));
  }
}

TEST(Motions, ThatCannotBeAreRefused) {
  const TemporaryFolder folder;
  const auto refuses = [&](const MotionHistory& history,
                           const std::string& part) {
    WriteMotions(folder / "motions.bin", history, 2);
    ExpectInputError([&] { ReadMotions(folder / "motions.bin"); }, part);
    folder.Write("old.bin", OfVersion('1', folder.Read("motions.bin")));
    ExpectInputError([&] { ReadMotions(folder / "old.bin"); }, part);
  };
  const auto with = [](int i, const std::function<void(NodeMotion&)>& edit) {
    MotionHistory history = TwoFrames();
    EditFrame(
        i, [&](FrameMotions& frame) { edit(frame.motions[i]); }, &history);
    return history;
  };
  refuses(with(1, [](NodeMotion& m) { m.translation.y() = std::nan(""); }),
          "frame 5, node 1: its motion is no rotation and translat");
  refuses(with(0, [](NodeMotion& m) { m.rotation(1, 1) += 0.1; }),
          "frame 3, node 0: its motion is no rotation");
  refuses(with(0, [](NodeMotion& m) { m.rotation *= -1; }),
          "frame 3, node 0: its motion is no rotation");
  WriteMotions(folder / "motions.bin", TwoFrames(), 2);
  std::string bytes = OfVersion('1', folder.Read("motions.bin"));
  constexpr std::size_t kSecondFrame = 16 + 8 + 2 * 48;
  bytes[kSecondFrame] = 3;
  folder.Write("old.bin", bytes);
  ExpectInputError([&] { ReadMotions(folder / "old.bin"); },
                   "frame 3: expected frames in ascending order");
}

TEST(Motions, OfMoreFramesThanTheFileHoldsAreNotAllocated) {
  const TemporaryFolder folder;
  folder.Write("huge.bin", "SFMOTN01" + std::string(16, '\xff'));
  ExpectInputError([&] { ReadMotions(folder / "huge.bin"); },
                   " bytes early: expected a complete file");
}

}  // namespace
}  // namespace splitfusion
