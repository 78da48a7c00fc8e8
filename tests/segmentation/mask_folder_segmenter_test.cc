#include "splitfusion/lib/segmentation/mask_folder_segmenter.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

class MaskFolderSegmenterTest : public testing::Test {
 protected:
  MaskFolderSegmenterTest() {
    frame_.stem = "000007";
    frame_.color = cv::Mat(24, 32, CV_8UC3, cv::Scalar::all(0));
    // Labels 1 (left, 4 columns) and 3 (right, 8 columns).
    labels_ = cv::Mat(24, 32, CV_8UC1, cv::Scalar(0));
    labels_.colRange(0, 4) = 1;
    labels_.colRange(20, 28) = 3;
  }

  void WriteLabels(const std::string& name = "000007.png") {
    cv::imwrite(folder_ / name, labels_);
  }
  std::vector<InstanceMask> Segment(
      const std::string& unnamed_class = kUnnamedClass) {
    return MaskFolderSegmenter(folder_ / "", unnamed_class).Segment(frame_);
  }

  TemporaryFolder folder_;
  Frame frame_;
  cv::Mat labels_;
};

TEST_F(MaskFolderSegmenterTest, JoinsLabelsWithTheirClassesBestFirst) {
  WriteLabels();
  folder_.Write("000007.json",
                R"([{"index": 1, "class": "chair", "score": 0.5},
                    {"index": 2, "class": "dog", "score": 0.9},
                    {"index": 3, "class": "person", "score": 0.8}])");
  const std::vector<InstanceMask> instances = Segment();
  ASSERT_EQ(instances.size(), 2u);  // The dog has no pixel.
  EXPECT_EQ(instances[0].class_name, "person");
  EXPECT_DOUBLE_EQ(instances[0].score, 0.8);
  EXPECT_EQ(cv::countNonZero(instances[0].mask), 8 * 24);
  EXPECT_EQ(instances[0].mask.at<uchar>(0, 20), 255);
  EXPECT_EQ(instances[1].class_name, "chair");
  EXPECT_EQ(cv::countNonZero(instances[1].mask), 4 * 24);
}

TEST_F(MaskFolderSegmenterTest, EveryValueIsAnInstanceWithoutClasses) {
  labels_.convertTo(labels_, CV_16U, 300);
  WriteLabels();
  const std::vector<InstanceMask> instances = Segment(kUnnamedRigidClass);
  ASSERT_EQ(instances.size(), 2u);
  EXPECT_EQ(instances[0].class_name, "rigid_object");
  EXPECT_EQ(cv::countNonZero(instances[0].mask), 4 * 24);
}

TEST_F(MaskFolderSegmenterTest, ABinaryMaskIsOneObject) {
  labels_ = labels_ > 0;
  WriteLabels();
  const std::vector<InstanceMask> instances = Segment();
  ASSERT_EQ(instances.size(), 1u);
  EXPECT_EQ(instances[0].class_name, "object");
  EXPECT_DOUBLE_EQ(instances[0].score, 1.0);
  EXPECT_EQ(cv::countNonZero(instances[0].mask), 12 * 24);
}

TEST_F(MaskFolderSegmenterTest, ReadsOneFilePerInstance) {
  WriteLabels("000007_teddy_bear_2.png");
  WriteLabels("000007_shirt.png");
  WriteLabels("000007_1.png");
  WriteLabels("000008_dog.png");
  const std::vector<InstanceMask> instances = Segment();
  ASSERT_EQ(instances.size(), 3u);
  EXPECT_EQ(instances[0].class_name, "object");
  EXPECT_EQ(instances[1].class_name, "shirt");
  EXPECT_EQ(instances[2].class_name, "teddy bear");
  EXPECT_EQ(cv::countNonZero(instances[2].mask), 12 * 24);
}

TEST_F(MaskFolderSegmenterTest, NamesTheClassesOfAFrame) {
  using Classes = std::set<std::string>;
  WriteLabels();
  WriteLabels("000008_teddy_bear_2.png");
  const MaskFolderSegmenter segmenter(folder_ / "");
  EXPECT_EQ(segmenter.ClassesOf("000007"), Classes{});
  EXPECT_EQ(segmenter.ClassesOf("000008"), Classes{"teddy bear"});
  EXPECT_EQ(segmenter.ClassesOf("000009"), Classes{});
  folder_.Write("000007.classes.txt", "1 robot\n2 1\n");
  EXPECT_EQ(segmenter.ClassesOf("000007"), (Classes{"person", "robot"}));
}

TEST_F(MaskFolderSegmenterTest, AFrameWithoutFileHasNoDetections) {
  WriteLabels("000001.png");
  EXPECT_TRUE(Segment().empty());
}

TEST_F(MaskFolderSegmenterTest, ReadsClassListsAndNamesByTheColourFile) {
  frame_.color_stem = "7.25";
  WriteLabels("7.25.png");
  folder_.Write("7.25.classes.txt",
                "# index class\n1 1\n2 63 # none here\n\n3 teddy bear\r\n");
  const std::vector<InstanceMask> instances = Segment();
  ASSERT_EQ(instances.size(), 2u);
  EXPECT_EQ(instances[0].class_name, "person");
  EXPECT_EQ(cv::countNonZero(instances[0].mask), 4 * 24);
  EXPECT_EQ(instances[1].class_name, "teddy bear");
  WriteLabels();  // Names by the depth file come first.
  EXPECT_EQ(Segment()[0].class_name, "object");
}

TEST_F(MaskFolderSegmenterTest, NamesBrokenInput) {
  ExpectInputError([&] { Segment(); }, "0 png files");
  ExpectInputError([&] { MaskFolderSegmenter segmenter(folder_ / "none"); },
                   "no such folder");
  WriteLabels();
  folder_.Write("000007.json", "{\"index\": 1}");
  ExpectInputError([&] { Segment(); }, "000007.json: no JSON list");
  folder_.Write("000007.json", "[{\"class\": \"dog\"}]");
  ExpectInputError([&] { Segment(); }, "expected an index of 1..65535");
  folder_.Write("000007.json", "[{\"index\": 1, \"score\": 7}]");
  ExpectInputError([&] { Segment(); }, "score of 0..1");
  std::filesystem::remove(folder_ / "000007.json");
  for (const char* line : {"1", "0 person", "2 81", "3 0", "person 1"}) {
    folder_.Write("000007.classes.txt", std::string("1 dog\n") + line);
    ExpectInputError([&] { Segment(); }, "000007.classes.txt:2");
  }
  std::filesystem::remove(folder_ / "000007.classes.txt");
  frame_.color = cv::Mat(48, 64, CV_8UC3);
  ExpectInputError([&] { Segment(); },
                   "000007.png: mask of 32x24: expected 64x48");
}

TEST_F(MaskFolderSegmenterTest, AnIndexThatComesTwiceIsRefused) {
  WriteLabels();
  folder_.Write("000007.classes.txt", "1 dog\n2 cat\n# again\n1 person\n");
  ExpectInputError([&] { Segment(); },
                   "000007.classes.txt:4: index 1 ('person') a second time: "
                   "expected each index of a frame once");
  folder_.Write("000007.json",
                R"([{"index": 2, "class": "dog"}, {"index": 2}])");
  ExpectInputError([&] { Segment(); },
                   "000007.json: index 2 ('object') a second time");
  // Other frames have indices of their own.
  const std::string lines =
      "{\"stem\": \"000007\", \"index\": 3}\n"
      "{\"stem\": \"000008\", \"index\": 3}\n";
  folder_.Write("detections.jsonl", lines);
  EXPECT_EQ(ReadDetectionLists(folder_ / "detections.jsonl", "object").size(),
            2u);
  folder_.Write("detections.jsonl", lines + lines);
  ExpectInputError(
      [&] { ReadDetectionLists(folder_ / "detections.jsonl", "object"); },
      "detections.jsonl:3: index 3 ('object') a second time");
}

TEST_F(MaskFolderSegmenterTest, RefusesColourMasks) {
  cv::imwrite(folder_ / "000007.png", frame_.color);
  ExpectInputError([&] { Segment(); }, "expected a label image");
}

TEST_F(MaskFolderSegmenterTest, FilesAreCheckedWithoutAFrame) {
  const auto check = [&](const std::string& stem, const cv::Size& size) {
    MaskFolderSegmenter(folder_ / "").CheckFiles(stem, size);
  };
  const cv::Size size(32, 24);
  WriteLabels();
  WriteLabels("000008_person.png");
  EXPECT_NO_THROW(check("000007", size));
  EXPECT_NO_THROW(check("000008", size));
  EXPECT_NO_THROW(check("000009", size)) << "without a file";
  ExpectInputError(
      [&] {
        check("000007", {64, 48});
      },
      "000007.png: mask of 32x24: expected 64x48");
  ExpectInputError([&] { check("000008", {64, 48}); }, "000008_person.png: m");
  folder_.Write("000007.json", R"([{"index": 1, "class": 7}])");
  ExpectInputError([&] { check("000007", size); }, "000007.json: detection");
  folder_.Write("000008_person.png", "no image");
  ExpectInputError([&] { check("000008", size); }, "000008_person.png: 8 byt");
}

TEST_F(MaskFolderSegmenterTest, DeepListsAreRefusedNotFollowed) {
  WriteLabels();
  const std::string deep(100000, '[');
  const std::string end(100000, ']');
  folder_.Write("000007.json", "[" + deep + end + "]");
  ExpectInputError([&] { Segment(); }, "000007.json: detection [[[[...]]]]");
  folder_.Write("000007.json", R"([{"index": )" + deep + end + "}]");
  ExpectInputError([&] { Segment(); }, "detection {\"index\":[[[...]]]}");
}

TEST(FindMaskFolder, KnowsClassLists) {
  TemporaryFolder folder;
  folder.Write("masks_noisy/readme.txt", "");
  EXPECT_EQ(FindMaskFolder(folder / ""), "");
  folder.Write("masks_noisy/7.classes.txt", "1 person\n");
  EXPECT_NE(FindMaskFolder(folder / "").find("masks_noisy"), std::string::npos);
}

TEST(FindMaskFolder, PrefersDetections) {
  const TemporaryFolder folder;
  EXPECT_EQ(FindMaskFolder(folder / ""), "");
  folder.Write("mask/0.png", "");
  EXPECT_EQ(FindMaskFolder(folder / ""), folder / "mask");
  folder.Write("masks_noisy/0.png", "");
  EXPECT_EQ(FindMaskFolder(folder / ""), folder / "mask");
  folder.Write("masks_noisy/0.json", "[]");
  EXPECT_EQ(FindMaskFolder(folder / ""), folder / "masks_noisy");
}

TEST_F(MaskFolderSegmenterTest, IndicesAreIdentitiesIfThatIsSaid) {
  WriteLabels();
  for (const InstanceMask& instance : Segment()) {
    EXPECT_EQ(instance.identity, 0);
  }
  MaskFolderSegmenter given(folder_ / "", kUnnamedClass,
                            /*given_identities=*/true);
  const std::vector<InstanceMask> instances = given.Segment(frame_);
  ASSERT_EQ(instances.size(), 2u);
  EXPECT_EQ(instances[0].identity, 1);
  EXPECT_EQ(instances[1].identity, 3);
}

}  // namespace
}  // namespace splitfusion
