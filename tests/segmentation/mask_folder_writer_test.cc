#include "splitfusion/lib/segmentation/mask_folder_writer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "splitfusion/lib/segmentation/mask_folder_segmenter.h"
#include "splitfusion/lib/segmentation/recording_segmenter.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

const std::map<std::string, std::string> kSettings = {{"model", "a.onnx"},
                                                      {"top_k", "100"}};

Frame MakeFrame(int index) {
  Frame frame;
  frame.index = index;
  frame.stem = "13" + std::to_string(index) + ".25";
  frame.color = cv::Mat(24, 32, CV_8UC3, cv::Scalar::all(0));
  return frame;
}

InstanceMask MakeInstance(const cv::Rect& inside, const std::string& name,
                          double score) {
  InstanceMask instance{cv::Mat(24, 32, CV_8UC1, cv::Scalar(0)), name, score,
                        inside};
  instance.mask(inside) = 255;
  return instance;
}

/// A person, a chair half behind the person, a dog on its own.
std::vector<InstanceMask> MakeInstances() {
  return {MakeInstance({4, 4, 10, 16}, "person", 0.9),
          MakeInstance({8, 10, 12, 8}, "chair", 0.71),
          MakeInstance({24, 0, 6, 6}, "dog", 0.7)};
}

void ExpectSame(const std::vector<InstanceMask>& found,
                const std::vector<InstanceMask>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].class_name, expected[i].class_name);
    EXPECT_EQ(found[i].score, expected[i].score);
    EXPECT_EQ(found[i].box, expected[i].box);
    EXPECT_EQ(cv::countNonZero(found[i].mask != expected[i].mask), 0) << i;
  }
}

int Lines(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

TEST(MaskFolderWriter, TheReaderGivesTheSameMasksOverlapsIncluded) {
  const TemporaryFolder folder;
  MaskFolderWriter writer(folder / "m", kSettings);
  EXPECT_FALSE(writer.Has("130.25"));
  writer.Write(MakeFrame(0), MakeInstances());
  writer.Write(MakeFrame(1), {});
  EXPECT_TRUE(writer.Has("130.25"));
  EXPECT_EQ(writer.size(), 2);
  MaskFolderSegmenter reader(folder / "m");
  ExpectSame(reader.Segment(MakeFrame(0)), MakeInstances());
  EXPECT_TRUE(reader.Segment(MakeFrame(1)).empty());
}

TEST(MaskFolderWriter, LabelImagesHaveTheBetterInstanceOnTop) {
  const TemporaryFolder folder;
  MaskFolderWriter(folder / "m", kSettings)
      .Write(MakeFrame(0), MakeInstances());
  const cv::Mat labels =
      cv::imread(folder / "m/130.25.png", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(labels.type(), CV_16UC1);
  EXPECT_EQ(labels.at<ushort>(12, 9), 1);   // Person over chair.
  EXPECT_EQ(labels.at<ushort>(12, 18), 2);  // Chair alone.
  EXPECT_EQ(labels.at<ushort>(0, 0), 0);
  EXPECT_TRUE(folder.Has("m/overlaps/130.25_2.png"));
  EXPECT_FALSE(folder.Has("m/overlaps/130.25_1.png"));
  const std::string list = folder.Read("m/detections.jsonl");
  EXPECT_EQ(list.substr(0, list.find('\n')),
            R"({"frame":0,"stem":"130.25","index":1,"class":"person",)"
            R"("score":0.9,"box":[4.0,4.0,14.0,20.0]})");
  EXPECT_NE(list.find(R"("mask":"overlaps/130.25_2.png")"), std::string::npos);
}

TEST(MaskFolderWriter, GoesOnAfterFramesThatAreComplete) {
  const TemporaryFolder folder;
  {
    MaskFolderWriter writer(folder / "m", kSettings);
    for (const int i : {0, 1, 2}) writer.Write(MakeFrame(i), MakeInstances());
  }
  const std::string whole = folder.Read("m/detections.jsonl");
  // Killed before the last label image was there, in the middle of a line.
  std::filesystem::remove(folder / "m/132.25.png");
  folder.Write("m/.132.25.tmp77.png", "half an image");
  folder.Write("m/detections.jsonl", whole.substr(0, whole.size() - 20));
  MaskFolderWriter writer(folder / "m", kSettings);
  EXPECT_TRUE(writer.Has("131.25"));
  EXPECT_FALSE(writer.Has("132.25"));
  EXPECT_EQ(Lines(folder.Read("m/detections.jsonl")), 6);
  writer.Write(MakeFrame(2), MakeInstances());
  EXPECT_EQ(folder.Read("m/detections.jsonl"), whole);
}

TEST(MaskFolderWriter, ImagesOfOthersAndChangedOnesAreNotCleared) {
  const TemporaryFolder folder;
  {
    MaskFolderWriter writer(folder / "m", kSettings);
    for (const int i : {0, 1}) writer.Write(MakeFrame(i), MakeInstances());
  }
  folder.Write("m/131.25.png", "edited by hand");
  folder.Write("m/my_own.png", "an image");
  const std::string list = folder.Read("m/written.jsonl");
  folder.Write("m/written.jsonl", list.substr(0, list.size() - 3));
  MaskFolderWriter writer(folder / "m", kSettings);
  EXPECT_TRUE(writer.Has("131.25")) << "not to be overwritten";
  writer.Write(MakeFrame(2), MakeInstances());
  ClearMaskFolder(folder / "m");
  EXPECT_FALSE(folder.Has("m/132.25.png"));
  EXPECT_FALSE(folder.Has("m/130.25.png"));
  EXPECT_EQ(folder.Read("m/131.25.png"), "edited by hand");
  EXPECT_EQ(folder.Read("m/my_own.png"), "an image");
}

TEST(MaskFolderWriter, AFolderWithoutItsListGoesOnButIsNotCleared) {
  const TemporaryFolder folder;
  MaskFolderWriter(folder / "m", kSettings).Write(MakeFrame(0), {});
  std::filesystem::remove(folder / "m/written.jsonl");
  ExpectInputError([&] { ClearMaskFolder(folder / "m"); },
                   "m: not overwritten, for it does not say which images");
  EXPECT_TRUE(folder.Has("m/130.25.png"));
  EXPECT_EQ(MaskFolderWriter(folder / "m", kSettings).size(), 1);
}

TEST(MaskFolderWriter, RefusesOtherSettingsAndOtherImages) {
  const TemporaryFolder folder;
  MaskFolderWriter(folder / "m", kSettings).Write(MakeFrame(0), {});
  auto settings = kSettings;
  settings["top_k"] = "5";
  ExpectInputError([&] { MaskFolderWriter writer(folder / "m", settings); },
                   "segmentation.json: masks were made with another top_k "
                   "(100, now 5): expected the same");
  folder.Write("mine/1.png", "an image");
  ExpectInputError([&] { MaskFolderWriter writer(folder / "mine", kSettings); },
                   "mine: holds png files without segmentation.json");
  ClearMaskFolder(folder / "mine");
  EXPECT_TRUE(folder.Has("mine/1.png"));
  folder.Write("m/notes.txt", "mine");
  folder.Write("m/overlaps/mine.png", "mine, too");
  ClearMaskFolder(folder / "m");
  EXPECT_EQ(folder.Read("m/overlaps/mine.png"), "mine, too");
  EXPECT_TRUE(folder.Has("m/notes.txt"));
  EXPECT_FALSE(folder.Has("m/130.25.png"));
  MaskFolderWriter writer(folder / "m", settings);
  EXPECT_EQ(writer.size(), 0);
  folder.Write("file", "");
  ExpectInputError([&] { MaskFolderWriter w(folder / "file", kSettings); },
                   "file: cannot be made (");
}

TEST(DetectionList, NamesTheBrokenLine) {
  const TemporaryFolder folder;
  cv::imwrite(folder / "7.png", cv::Mat(24, 32, CV_8UC1, cv::Scalar(1)));
  const std::string good = R"({"stem":"7","index":1,"class":"dog"})";
  const auto read = [&](const std::string& text) {
    folder.Write("detections.jsonl", text);
    MaskFolderSegmenter segmenter(folder / "");
    Frame frame = MakeFrame(0);
    frame.stem = "7";
    return segmenter.Segment(frame);
  };
  EXPECT_EQ(read(good + "\n").at(0).class_name, "dog");
  EXPECT_TRUE(read("").empty());
  ExpectInputError([&] { read(good + "\n{\"stem\""); },
                   "detections.jsonl:2: expected an object with stem, index");
  ExpectInputError([&] { read("[1]\n"); }, "detections.jsonl:1: expected");
  ExpectInputError([&] { read(R"({"stem":"7","index":0})"); },
                   "detections.jsonl:1: detection");
  ExpectInputError([&] { read(R"({"stem":"7","index":1,"box":[1,2]})"); },
                   "the 4 corners of a box");
  ExpectInputError([&] { read(R"({"stem":"7","index":1,"mask":"no.png"})"); },
                   "no.png");
}

/// Gives the instances of the other tests.
class ConstantSegmenter : public Segmenter {
 public:
  std::vector<InstanceMask> Segment(const Frame&) override {
    return MakeInstances();
  }
};

TEST(RecordingSegmenter, PassesOnAndKeepsTheMasks) {
  const TemporaryFolder folder;
  RecordingSegmenter recording(std::make_unique<ConstantSegmenter>(),
                               folder / "kept", kSettings);
  EXPECT_FALSE(folder.Has("kept"));
  ExpectSame(recording.Segment(MakeFrame(3)), MakeInstances());
  MaskFolderSegmenter reader(folder / "kept");
  ExpectSame(reader.Segment(MakeFrame(3)), MakeInstances());
}

TEST(RecordingSegmenter, DoesNotRecordAFrameTwice) {
  const TemporaryFolder folder;
  for (int run = 0; run < 2; ++run) {
    RecordingSegmenter recording(std::make_unique<ConstantSegmenter>(),
                                 folder / "kept", kSettings);
    ExpectSame(recording.Segment(MakeFrame(3)), MakeInstances());
  }
  EXPECT_EQ(Lines(folder.Read("kept/detections.jsonl")), 3);
  MaskFolderSegmenter reader(folder / "kept");
  ExpectSame(reader.Segment(MakeFrame(3)), MakeInstances());
}

}  // namespace
}  // namespace splitfusion
