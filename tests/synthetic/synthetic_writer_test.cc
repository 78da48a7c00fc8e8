#include "splitfusion/lib/synthetic/synthetic_writer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/segmentation/mask_folder_segmenter.h"
#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "splitfusion/lib/sequence/trajectory.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

SyntheticOptions TinyOptions() {
  SyntheticOptions options;
  options.width = 128;
  options.height = 96;
  options.frames = 4;
  options.track_points = 50;
  return options;
}

SyntheticWriterOptions EveryOther() {
  SyntheticWriterOptions options;
  options.mesh_every = 2;
  options.seen_every = 2;
  return options;
}

/// Relative path and content of every file below a folder but the marker.
std::map<std::string, std::string> Contents(const TemporaryFolder& folder,
                                            const std::string& name) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::recursive_directory_iterator(folder / name)) {
    if (!entry.is_regular_file()) continue;
    const std::string path = fs::relative(entry.path(), folder / "").string();
    if (entry.path().filename() == "sf_synth.json") continue;  // A new id.
    contents[path.substr(name.size())] = folder.Read(path);
  }
  return contents;
}

/// Names directly below a folder, hidden ones too.
std::size_t EntryCount(const std::string& folder) {
  const fs::directory_iterator entries(folder);
  return std::distance(begin(entries), end(entries));
}

class SyntheticWriterTest : public ::testing::Test {
 protected:
  void Write(const std::string& name, bool overwrite = false) {
    SyntheticWriterOptions options = EveryOther();
    options.overwrite = overwrite;
    WriteSyntheticSequence(TinyOptions(), options, folder_ / name);
  }

  TemporaryFolder folder_;
};

TEST_F(SyntheticWriterTest, TheReaderReadsIt) {
  Write("seq");
  const SyntheticScene scene(TinyOptions());
  ReaderOptions options;
  options.depth = {};
  ImageFolderReader reader(folder_ / "seq", options);
  ASSERT_EQ(reader.size(), 4);
  EXPECT_NEAR(reader.camera().fx, scene.camera().fx, 1e-9);
  EXPECT_NEAR(reader.camera().cy, scene.camera().cy, 1e-9);
  EXPECT_EQ(reader.calibration().depth_scale, 5000);
  for (int i = 0; i < 4; ++i) {
    const auto frame = reader.Next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->stem, scene.Stem(i));
    EXPECT_NEAR(frame->timestamp, scene.Timestamp(i), 1e-6);
    const SyntheticFrame expected = scene.Render(i);
    EXPECT_EQ(cv::norm(frame->color, expected.frame.color, cv::NORM_INF), 0);
    // The reader drops what it thinks unreliable; the rest is the same.
    const cv::Mat kept = frame->depth > 0;
    EXPECT_GT(cv::countNonZero(kept), 0.5 * kept.total());
    EXPECT_LT(cv::norm(frame->depth, expected.frame.depth, cv::NORM_INF, kept),
              0.03);
  }
  EXPECT_FALSE(reader.Next());
}

TEST_F(SyntheticWriterTest, TheMaskReaderReadsIt) {
  Write("seq");
  const SyntheticScene scene(TinyOptions());
  EXPECT_EQ(FindMaskFolder(folder_ / "seq"), folder_ / "seq/masks_noisy");
  MaskFolderSegmenter segmenter(folder_ / "seq/masks_noisy");
  for (int i = 0; i < 4; ++i) {
    const SyntheticFrame rendered = scene.Render(i);
    const auto expected = scene.Detections(rendered);
    const auto found = segmenter.Segment(rendered.frame);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].class_name, expected[k].class_name);
      EXPECT_NEAR(found[k].score, expected[k].score, 6e-4);
    }
  }
}

TEST_F(SyntheticWriterTest, GroundTruthPosesAreExact) {
  Write("seq");
  const SyntheticScene scene(TinyOptions());
  for (const char* name : {"seq/groundtruth.txt", "seq/gt/groundtruth.txt"}) {
    const Trajectory poses = ReadTumTrajectory(folder_ / name);
    ASSERT_EQ(poses.size(), 4u);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(poses[i].timestamp, scene.Timestamp(i), 1e-6);
      EXPECT_TRUE(
          poses[i].world_from_camera.isApprox(scene.WorldFromCamera(i), 1e-7));
    }
  }
}

TEST_F(SyntheticWriterTest, StaticMeshTellsWhatWasSeen) {
  Write("seq");
  PlyProperties extra;
  const TriangleMesh mesh = ReadPly(folder_ / "seq/gt/static_mesh.ply", &extra);
  ASSERT_EQ(extra["seen"].size(), mesh.vertices.size());
  ASSERT_EQ(extra["label"].size(), mesh.vertices.size());
  int seen = 0, behind_camera = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_LE(extra["seen"][i], 2);  // Frames 0 and 2.
    seen += extra["seen"][i] > 0;
    const bool behind = mesh.vertices[i].y() < -2.2f;
    behind_camera += behind && extra["seen"][i] > 0;
  }
  EXPECT_GT(seen, 1000);
  EXPECT_LT(seen, 0.5 * mesh.vertices.size());
  EXPECT_EQ(behind_camera, 0);
}

TEST_F(SyntheticWriterTest, PosedMeshesKeepTheirVertices) {
  Write("seq");
  const SyntheticScene scene(TinyOptions());
  const std::string head = folder_ / "seq/gt/mesh/inst1_";
  const TriangleMesh first = ReadPly(head + scene.Stem(0) + ".ply");
  const TriangleMesh later = ReadPly(head + scene.Stem(2) + ".ply");
  EXPECT_FALSE(fs::exists(head + scene.Stem(1) + ".ply"));
  EXPECT_EQ(first.triangles, later.triangles);
  EXPECT_EQ(later.vertices, scene.PosedMesh(kPersonId, 2).vertices);
}

TEST_F(SyntheticWriterTest, TracksHaveTheDocumentedLayout) {
  Write("seq");
  const SyntheticScene scene(TinyOptions());
  const std::string bytes = folder_.Read("seq/gt/tracks.bin");
  const std::size_t frames = 4, points = 100;
  ASSERT_EQ(bytes.size(), 16 + points * 16 + frames * points * 13);
  std::uint32_t header[4];
  std::memcpy(header, bytes.data(), 16);
  EXPECT_EQ(header[0], 0x4b525431u);
  EXPECT_EQ(header[1], 1u);
  EXPECT_EQ(header[2], frames);
  EXPECT_EQ(header[3], points);
  const auto expected = scene.TrackPositions(3);
  float position[3];
  const std::size_t at = 16 + points * 16 + (3 * points + 99) * 12;
  std::memcpy(position, bytes.data() + at, 12);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(position[k], expected[99][k]);
  const auto visible = scene.TrackVisibility(scene.Render(3));
  EXPECT_EQ(bytes.back() != 0, visible.back());
}

TEST_F(SyntheticWriterTest, LabelsNameTheInstances) {
  Write("seq");
  const auto labels = nlohmann::json::parse(folder_.Read("seq/gt/labels.json"));
  ASSERT_EQ(labels["instances"].size(), 3u);
  EXPECT_EQ(labels["instances"][0]["id"], 1);
  EXPECT_EQ(labels["instances"][0]["category"], "person");
  EXPECT_EQ(labels["instances"][0]["rigid"], false);
  EXPECT_EQ(labels["instances"][2]["moving"], false);
  const auto config = nlohmann::json::parse(folder_.Read("seq/gt/config.json"));
  EXPECT_EQ(config["seed"], 1);
  EXPECT_EQ(config["scene"], "room_person");
}

TEST_F(SyntheticWriterTest, SameOptionsSameBytes) {
  Write("a");
  Write("b");
  const auto a = Contents(folder_, "a"), b = Contents(folder_, "b");
  ASSERT_EQ(a.size(), b.size());
  EXPECT_GT(a.size(), 30u);
  for (const auto& [path, content] : a) {
    ASSERT_EQ(b.count(path), 1u) << path;
    EXPECT_TRUE(b.at(path) == content) << path;
  }
}

TEST_F(SyntheticWriterTest, ReportsProgress) {
  std::vector<int> done;
  WriteSyntheticSequence(TinyOptions(), {}, folder_ / "seq",
                         [&](int frames) { done.push_back(frames); });
  EXPECT_EQ(done, (std::vector<int>{1, 2, 3, 4}));
}

TEST_F(SyntheticWriterTest, AFailureLeavesNothingBehind) {
  const auto fail = [](int frames) {
    if (frames == 2) throw std::runtime_error("stop");
  };
  EXPECT_THROW(WriteSyntheticSequence(TinyOptions(), {}, folder_ / "seq", fail),
               std::runtime_error);
  EXPECT_EQ(EntryCount(folder_ / ""), 0u);
}

TEST_F(SyntheticWriterTest, AFailedOverwriteKeepsTheOldSequence) {
  Write("seq");
  const auto before = Contents(folder_, "seq");
  SyntheticWriterOptions options;
  options.overwrite = true;
  const auto fail = [](int) { throw std::runtime_error("stop"); };
  EXPECT_THROW(
      WriteSyntheticSequence(TinyOptions(), options, folder_ / "seq", fail),
      std::runtime_error);
  EXPECT_EQ(Contents(folder_, "seq"), before);
  EXPECT_EQ(EntryCount(folder_ / ""), 1u);
}

TEST_F(SyntheticWriterTest, RefusesAFolderThatIsNotEmpty) {
  Write("seq");
  ExpectInputError([&] { Write("seq"); },
                   "exists and is not empty; expected a new folder");
  EXPECT_NO_THROW(Write("seq", /*overwrite=*/true));
  EXPECT_EQ(EntryCount(folder_ / ""), 1u);
}

TEST_F(SyntheticWriterTest, OverwritesOnlyItsOwnSequences) {
  folder_.Write("home/thesis.txt", "years of work");
  // A recording: it has an associations.txt, but nothing says who made it.
  folder_.Write("recording/associations.txt", "0 rgb/0.png 0 depth/0.png\n");
  folder_.Write("recording/rgb/0.png", "an image");
  for (const char* name : {"home", "recording"}) {
    ExpectInputError([&] { Write(name, /*overwrite=*/true); },
                     "not overwritten, for sf_synth did not write it");
  }
  EXPECT_EQ(folder_.Read("home/thesis.txt"), "years of work");
  EXPECT_EQ(folder_.Read("recording/rgb/0.png"), "an image");
}

TEST_F(SyntheticWriterTest, OverwritingKeepsFilesOfOthers) {
  Write("seq");
  folder_.Write("seq/notes.txt", "mine");
  folder_.Write("seq/masks/0.png", "drawn by hand");
  SyntheticOptions shorter = TinyOptions();
  shorter.frames = 2;
  SyntheticWriterOptions options = EveryOther();
  options.overwrite = true;
  const auto kept = WriteSyntheticSequence(shorter, options, folder_ / "seq");
  EXPECT_EQ(kept, (std::vector<std::string>{"masks/0.png", "notes.txt"}));
  EXPECT_EQ(folder_.Read("seq/notes.txt"), "mine");
  EXPECT_EQ(folder_.Read("seq/masks/0.png"), "drawn by hand");
  EXPECT_EQ(ImageFolderReader(folder_ / "seq").size(), 2);
  EXPECT_EQ(EntryCount(folder_ / "seq/rgb"), 2u) << "old frames are gone";
  EXPECT_EQ(EntryCount(folder_ / ""), 1u);
}

TEST_F(SyntheticWriterTest, ChangedFilesAreNotOverwritten) {
  Write("seq");
  folder_.Write("seq/calibration.txt", "my own numbers");
  const auto before = Contents(folder_, "seq");
  ExpectInputError([&] { Write("seq", /*overwrite=*/true); },
                   "seq/calibration.txt: not overwritten, for it was changed");
  EXPECT_EQ(Contents(folder_, "seq"), before);
  EXPECT_EQ(EntryCount(folder_ / ""), 1u);
}

TEST_F(SyntheticWriterTest, AFileOfOthersUnderANewNameIsNotOverwritten) {
  SyntheticOptions shorter = TinyOptions();
  shorter.frames = 2;
  WriteSyntheticSequence(shorter, EveryOther(), folder_ / "seq");
  const std::string later =
      "seq/rgb/" + SyntheticScene(TinyOptions()).Stem(3) + ".png";
  folder_.Write(later, "mine");
  ExpectInputError([&] { Write("seq", /*overwrite=*/true); },
                   ".png: not overwritten, for sf_synth did not write it");
  EXPECT_EQ(folder_.Read(later), "mine");
  EXPECT_EQ(ImageFolderReader(folder_ / "seq").size(), 2);
  EXPECT_EQ(EntryCount(folder_ / ""), 1u);
}

TEST_F(SyntheticWriterTest, ALinkToASequenceStays) {
  Write("seq");
  fs::create_directory_symlink(folder_ / "seq", folder_ / "link");
  Write("link", /*overwrite=*/true);
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(EntryCount(folder_ / ""), 2u);
}

TEST_F(SyntheticWriterTest, AnEmptyFolderAndASlashAtTheEndAreFine) {
  fs::create_directories(folder_ / "empty");
  Write("empty/");
  EXPECT_TRUE(folder_.Has("empty/associations.txt"));
}

TEST_F(SyntheticWriterTest, NamesWhatIsWrong) {
  folder_.Write("file", "x");
  ExpectInputError([&] { Write("file"); }, "is a file, expected a folder");
  ExpectInputError([&] { Write("file/seq"); }, "file/seq: cannot be written");
  SyntheticWriterOptions options;
  options.mesh_every = 0;
  ExpectInputError(
      [&] { WriteSyntheticSequence(TinyOptions(), options, folder_ / "x"); },
      "mesh_every = 0");
  ExpectInputError([&] { WriteSyntheticSequence(TinyOptions(), {}, ""); },
                   "directory = '': expected the folder to write");
}

TEST(WritePly, RejectsExtraPropertiesOfAnotherLength) {
  const TemporaryFolder folder;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}};
  ExpectInputError(
      [&] {
        WritePly(folder / "mesh.ply", mesh, {{"seen", {1.0}}});
      },
      "values of 'seen' = 1: expected 2, one a vertex");
}

}  // namespace
}  // namespace splitfusion
