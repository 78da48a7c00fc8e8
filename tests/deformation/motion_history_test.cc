#include "splitfusion/lib/deformation/motion_history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>

#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/lib/base/error.h"
#include "support/expect_input_error.h"
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
  history.frames.push_back({3, true, {Motion(0.1), Motion(0.2)}, {0, 1}});
  history.frames.push_back({5, false, {Motion(0.3), Motion(0.4)}});
  return history;
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
  EXPECT_FALSE(read.frames[0].Saw(0));
  EXPECT_TRUE(read.frames[0].Saw(1));
  EXPECT_FALSE(read.frames[1].Saw(1)) << "not known";
}

TEST(Motions, HaveTheDocumentedLayout) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", TwoFrames());
  const std::string bytes = folder.Read("motions.bin");
  ASSERT_EQ(bytes.size(), 8 + 8 + 2 * (8 + 2 * 49) + 8);
  EXPECT_EQ(bytes.substr(0, 8), "SFMOTN03");
  std::uint64_t checksum = 0;
  bytes.copy(reinterpret_cast<char*>(&checksum), 8, bytes.size() - 8);
  EXPECT_EQ(checksum, Checksum64(bytes.data(), bytes.size() - 8));
  float translation_y = 0;
  bytes.copy(reinterpret_cast<char*>(&translation_y), 4, 24 + 10 * 4);
  EXPECT_EQ(translation_y, 2);
  EXPECT_EQ(bytes.substr(24 + 2 * 48, 2), std::string("\0\1", 2));
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

TEST(Motions, EveryChangedByteIsNoticed) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", TwoFrames());
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

/// The file of TwoFrames() as version 01 had it: without a checksum, and
/// without what was seen.
std::string FirstVersion(std::string bytes) {
  bytes.resize(bytes.size() - 8);
  constexpr std::size_t kSeen = 2, kFrame = 8 + 2 * 48, kHead = 16;
  bytes.erase(kHead + 2 * kFrame + kSeen, kSeen);
  bytes.erase(kHead + kFrame, kSeen);
  bytes[7] = '1';
  return bytes;
}

/// As version 02 had it: with a checksum.
std::string SecondVersion(const std::string& bytes) {
  std::string second = FirstVersion(bytes);
  second[7] = '2';
  const std::uint64_t checksum = Checksum64(second.data(), second.size());
  return second.append(reinterpret_cast<const char*>(&checksum), 8);
}

TEST(Motions, OfOlderVersionsAreRead) {
  const TemporaryFolder folder;
  WriteMotions(folder / "motions.bin", TwoFrames());
  const std::string bytes = folder.Read("motions.bin");
  for (const std::string& old : {FirstVersion(bytes), SecondVersion(bytes)}) {
    folder.Write("old.bin", old);
    const MotionHistory read = ReadMotions(folder / "old.bin");
    ASSERT_EQ(read.frames.size(), 2u);
    EXPECT_TRUE(read.frames[1].motions[1].rotation.isApprox(
        Motion(0.4).rotation, 1e-6));
    EXPECT_TRUE(read.frames[0].seen.empty());
  }
}

TEST(Motions, ThatCannotBeAreRefused) {
  const TemporaryFolder folder;
  const auto refuses = [&](const MotionHistory& history,
                           const std::string& part) {
    WriteMotions(folder / "motions.bin", history);
    ExpectInputError([&] { ReadMotions(folder / "motions.bin"); }, part);
    folder.Write("old.bin", FirstVersion(folder.Read("motions.bin")));
    ExpectInputError([&] { ReadMotions(folder / "old.bin"); }, part);
  };
  MotionHistory history = TwoFrames();
  history.frames[1].motions[1].translation.y() = std::nan("");
  refuses(history, "frame 5, node 1: its motion is no rotation and translat");
  history = TwoFrames();
  history.frames[0].motions[0].rotation(1, 1) += 0.1;
  refuses(history, "frame 3, node 0: its motion is no rotation");
  history = TwoFrames();
  history.frames[0].motions[0].rotation *= -1;
  refuses(history, "frame 3, node 0: its motion is no rotation");
  history = TwoFrames();
  std::swap(history.frames[0], history.frames[1]);
  refuses(history, "frame 3: expected frames in ascending order");
}

TEST(Motions, OfMoreFramesThanTheFileHoldsAreNotAllocated) {
  const TemporaryFolder folder;
  folder.Write("huge.bin", "SFMOTN03" + std::string(8, '\xff'));
  ExpectInputError([&] { ReadMotions(folder / "huge.bin"); },
                   "huge.bin: 16 bytes: expected ");
}

}  // namespace
}  // namespace splitfusion
