#include "splitfusion/lib/base/archive.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "splitfusion/lib/base/archive_file.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

enum class Colour { kRed, kBlue };

/// One value of every kind.
struct Everything {
  int number = 0;
  bool truth = false;
  Colour colour = Colour::kRed;
  std::string text;
  std::vector<double> plain;
  std::vector<std::vector<int>> nested;
  std::deque<std::string> texts;
  std::array<std::string, 2> pair_of_texts;
  std::map<std::pair<int, int>, std::string> map;
  std::set<int> set;
  std::optional<Eigen::Vector3f> some, none = Eigen::Vector3f::Zero();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3i> triangles;
  cv::Mat image;
  cv::Mat_<float> depth;
  cv::Mat_<uchar> empty = cv::Mat_<uchar>(1, 1);

  template <typename Archive>
  void Serialize(Archive* archive) {
    archive->Section("everything");
    (*archive)(number, truth, colour, text, plain, nested, texts, pair_of_texts,
               map, set, some, none, motion, triangles, image, depth, empty);
  }
};

Everything Sample() {
  Everything sample;
  sample.number = -7;
  sample.truth = true;
  sample.colour = Colour::kBlue;
  sample.text = std::string("two\nlines\0and a zero", 20);
  sample.plain = {0.1, std::numeric_limits<double>::quiet_NaN(), -0.0};
  sample.nested = {{1, 2}, {}, {3}};
  sample.texts = {"a", "b"};
  sample.pair_of_texts = {"c", ""};
  sample.map = {{{1, 2}, "x"}, {{1, 3}, "y"}};
  sample.set = {5, 1};
  sample.some = Eigen::Vector3f(1, 2, 3);
  sample.none.reset();
  sample.motion.translation() = Eigen::Vector3d(0.1, 0.2, 0.3);
  sample.triangles = {{0, 1, 2}, {2, 1, 3}};
  const int sizes[] = {2, 3, 2};
  sample.image = cv::Mat(3, sizes, CV_8UC3, cv::Scalar(1, 2, 3));
  sample.depth = cv::Mat_<float>(6, 8, 1.5f)(cv::Rect(1, 2, 3, 4));
  sample.empty.release();
  return sample;
}

std::string Bytes(const Everything& value) {
  std::ostringstream out;
  ArchiveWriter writer(&out);
  writer(value);
  writer.Flush();
  return out.str();
}

Everything Parse(const std::string& bytes) {
  std::istringstream in(bytes);
  ArchiveReader reader(&in, bytes.size(), "a.bin");
  Everything value;
  reader(value);
  EXPECT_EQ(reader.left(), 0u);
  return value;
}

TEST(Archive, GivesEveryKindOfValueBack) {
  const Everything sample = Sample();
  const Everything read = Parse(Bytes(sample));
  EXPECT_EQ(read.number, -7);
  EXPECT_TRUE(read.truth);
  EXPECT_EQ(read.colour, Colour::kBlue);
  EXPECT_EQ(read.text, sample.text);
  ASSERT_EQ(read.plain.size(), 3u);
  EXPECT_TRUE(std::isnan(read.plain[1]) && std::signbit(read.plain[2]));
  EXPECT_EQ(read.nested, sample.nested);
  EXPECT_EQ(read.texts, sample.texts);
  EXPECT_EQ(read.pair_of_texts, sample.pair_of_texts);
  EXPECT_EQ(read.map, sample.map);
  EXPECT_EQ(read.set, sample.set);
  EXPECT_EQ(*read.some, *sample.some);
  EXPECT_FALSE(read.none.has_value());
  EXPECT_EQ(read.motion.matrix(), sample.motion.matrix());
  EXPECT_EQ(read.triangles, sample.triangles);
  ASSERT_EQ(read.image.dims, 3);
  EXPECT_EQ(read.image.type(), CV_8UC3);
  EXPECT_EQ(cv::norm(read.image, sample.image), 0);
  EXPECT_EQ(read.depth.size(), sample.depth.size());
  EXPECT_EQ(cv::norm(read.depth, sample.depth), 0);
  EXPECT_TRUE(read.empty.empty());
  EXPECT_EQ(Bytes(read), Bytes(sample));
}

TEST(Archive, PassesMoreThanItsBuffersHold) {
  std::vector<std::uint32_t> large(900000);
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = 7 * i;
  std::ostringstream out;
  ArchiveWriter writer(&out);
  writer(1, large, std::uint8_t{2}, large, 3);
  writer.Flush();
  std::istringstream in(out.str());
  ArchiveReader reader(&in, out.str().size(), "a.bin");
  int first = 0, last = 0;
  std::uint8_t middle = 0;
  std::vector<std::uint32_t> a, b;
  reader(first, a, middle, b, last);
  EXPECT_EQ(first, 1);
  EXPECT_EQ(middle, 2);
  EXPECT_EQ(last, 3);
  EXPECT_TRUE(a == large && b == large);
}

TEST(Archive, RefusesToEndEarlyWhereverItIsCut) {
  const std::string bytes = Bytes(Sample());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(Parse(bytes.substr(0, size)), InputError) << size;
  }
}

TEST(Archive, SurvivesWrongBytes) {
  const std::string bytes = Bytes(Sample());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const int flip : {1, 0x80, 0xff}) {
      std::string wrong = bytes;
      wrong[i] = static_cast<char>(wrong[i] ^ flip);
      std::istringstream in(wrong);
      ArchiveReader reader(&in, wrong.size(), "a.bin");
      Everything value;
      try {
        reader(value);  // Numbers may be any.
      } catch (const InputError&) {
      }
    }
  }
}

TEST(Archive, FindsWhereSectionsDoNotFit) {
  std::ostringstream out;
  ArchiveWriter writer(&out);
  writer.Section("one");
  writer(1);
  writer.Section("two");
  writer.Flush();
  const std::string bytes = out.str();
  std::istringstream in(bytes);
  ArchiveReader reader(&in, bytes.size(), "a.bin");
  reader.Section("one");
  std::int16_t part = 0;
  reader(part);
  ExpectInputError([&] { reader.Section("two"); },
                   "a.bin: section 'one': ends where 'two' was expected");
}

TEST(Archive, RefusesImagesOfAnotherType) {
  std::ostringstream out;
  ArchiveWriter writer(&out);
  writer(cv::Mat_<float>(2, 2, 1.f));
  writer.Flush();
  std::istringstream in(out.str());
  ArchiveReader reader(&in, out.str().size(), "a.bin");
  cv::Mat_<uchar> image;
  ExpectInputError([&] { reader(image); }, "expected type 0");
}

constexpr std::uint32_t kVersion = 3;

std::string WriteSample(const TemporaryFolder& folder) {
  const std::string path = folder / "state.bin";
  WriteArchiveFile(path, kVersion,
                   [](ArchiveWriter* archive) { (*archive)(Sample()); });
  return path;
}

void Read(const std::string& path, std::uint32_t version = kVersion) {
  ReadArchiveFile(path, version, [](ArchiveReader* archive) {
    Everything value;
    (*archive)(value);
    EXPECT_EQ(Bytes(value), Bytes(Sample()));
  });
}

TEST(ArchiveFile, IsReadAsWritten) {
  const TemporaryFolder folder;
  Read(WriteSample(folder));
}

TEST(ArchiveFile, IsRefusedWhereverItIsCutOrChanged) {
  const TemporaryFolder folder;
  WriteSample(folder);
  const std::string bytes = folder.Read("state.bin");
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::string cut = folder.Write("cut.bin", bytes.substr(0, i));
    ExpectInputError([&] { Read(cut); }, "cut.bin: ");
    std::string wrong = bytes;
    wrong[i] ^= 1;
    const std::string flipped = folder.Write("flipped.bin", wrong);
    ExpectInputError([&] { Read(flipped); }, "flipped.bin: ");
  }
  const std::string longer = folder.Write("longer.bin", bytes + "x");
  ExpectInputError([&] { Read(longer); }, "longer.bin: damaged");
}

TEST(ArchiveFile, IsRefusedInAnotherVersion) {
  const TemporaryFolder folder;
  const std::string path = WriteSample(folder);
  ExpectInputError([&] { Read(path, kVersion + 1); },
                   "state.bin: version 3: expected version 4");
  ExpectInputError([&] { Read(folder / "missing.bin"); }, "cannot be opened");
}

TEST(ArchiveFile, HasToBeReadToItsEnd) {
  const TemporaryFolder folder;
  const std::string path = WriteSample(folder);
  ExpectInputError(
      [&] { ReadArchiveFile(path, kVersion, [](ArchiveReader*) {}); },
      "bytes before the file");
}

TEST(ArchiveFile, AFailureLeavesTheOldOne) {
  const TemporaryFolder folder;
  const std::string path = WriteSample(folder);
  EXPECT_THROW(WriteArchiveFile(path, kVersion,
                                [](ArchiveWriter* archive) {
                                  (*archive)(1);
                                  throw InputError("no more");
                                }),
               InputError);
  Read(path);
  EXPECT_FALSE(folder.Has(".state.tmp" + std::to_string(getpid()) + ".bin"));
  ExpectInputError(
      [] {
        WriteArchiveFile("/dev/full/state.bin", kVersion,
                         [](ArchiveWriter*) {});
      },
      "cannot be written");
}

}  // namespace
}  // namespace splitfusion
