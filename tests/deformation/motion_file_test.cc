#include "splitfusion/lib/deformation/motion_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "deformation/sample_motions.h"
#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/lib/base/error.h"
#include "support/expect_input_error.h"
#include "support/motion_frames.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

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
