// Files that evaluation reads: what is wrong with them is said in one line.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/evaluation/recorded_run.h"
#include "splitfusion/lib/evaluation/track_error.h"
#include "splitfusion/lib/evaluation/track_point.h"
#include "splitfusion/lib/evaluation/true_tracks.h"
#include "support/bent_plate.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// The message of the InputError that `action` throws.
std::string Message(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(TrackPoints, RoundTripAndFurtherColumns) {
  const TemporaryFolder folder;
  const std::string path = folder.Write(
      "q.csv", "id,frame,x,y,z,instance\n# remark\n3,50,0.5,-1,2.25,7\n");
  const auto points = ReadTrackPoints(path);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].id, 3);
  EXPECT_EQ(points[0].frame, 50);
  EXPECT_EQ(points[0].position, Eigen::Vector3d(0.5, -1, 2.25));
  WriteTrackPoints(folder / "out.csv", points);
  EXPECT_EQ(folder.Read("out.csv"),
            "id,frame,x,y,z\n3,50,0.500000,-1.000000,2.250000\n");
}

TEST(TrackPoints, NameTheBadLine) {
  const TemporaryFolder folder;
  const std::string path =
      folder.Write("q.csv", "id,frame,x,y,z\n1,2,3,4,5\n1,2,nan,4,5\n");
  EXPECT_THAT(Message([&] { ReadTrackPoints(path); }),
              AllOf(HasSubstr("q.csv:3"), HasSubstr("id,frame,x,y,z"),
                    Not(HasSubstr("\n"))));
  folder.Write("q.csv", "id,frame,x,y,z\n");
  EXPECT_THAT(Message([&] { ReadTrackPoints(path); }), HasSubstr("no row"));
  EXPECT_THAT(Message([&] { ReadTrackPoints(folder / "none.csv"); }),
              HasSubstr("none.csv: cannot be opened"));
}

class FilesOfARun : public ::testing::Test {
 protected:
  FilesOfARun() {
    std::filesystem::create_directories(folder_ / "run");
    BentPlate().WriteRun(folder_ / "run");
    BentPlate().WriteGroundTruth(folder_ / "gt");
  }
  std::string ReadMessage() const {
    return Message([&] { ReadRun(folder_ / "run"); });
  }

  TemporaryFolder folder_;
};

TEST_F(FilesOfARun, AreRead) {
  const RecordedRun run = ReadRun(folder_ / "run");
  EXPECT_EQ(run.frames.size(), 12u);
  EXPECT_EQ(run.Find(3)->stem, "stem3");
  EXPECT_EQ(run.Find(12), nullptr);
  ASSERT_EQ(run.surfaces.size(), 2u);
  EXPECT_EQ(run.surfaces[0].label, "background");
  EXPECT_EQ(run.surfaces[1].id, 1);
  EXPECT_EQ(run.surfaces[1].label, "thin_plate");
  EXPECT_EQ(run.surfaces[1].neighbors_per_point, 6);
  ASSERT_TRUE(run.camera);
  EXPECT_EQ(run.camera->width, 160);
}

TEST_F(FilesOfARun, SequenceOfTheFlagsHasTheCamera) {
  std::filesystem::create_directories(folder_ / "sequence");
  std::filesystem::rename(folder_ / "run/calibration.txt",
                          folder_ / "sequence/calibration.txt");
  EXPECT_FALSE(ReadRun(folder_ / "run").camera);
  folder_.Write("run/options.flags",
                "# flags\n--sequence=" + (folder_ / "sequence") + "\n");
  EXPECT_TRUE(ReadRun(folder_ / "run").camera);
}

TEST_F(FilesOfARun, TrajectoryAloneIsARun) {
  std::filesystem::remove(folder_ / "run/frames.jsonl");
  std::filesystem::remove_all(folder_ / "run/surfaces");
  const RecordedRun run = ReadRun(folder_ / "run");
  EXPECT_EQ(run.Find(3)->stem, "");
  EXPECT_TRUE(run.surfaces.empty());
}

TEST_F(FilesOfARun, MissingOrContradictoryOnesAreNamed) {
  folder_.Write("run/frames.jsonl", R"({"frame": 0, "stem": "a"})"
                                    "\n");
  EXPECT_THAT(ReadMessage(), HasSubstr("1 lines: expected one for each of "
                                       "the 12 poses"));
  folder_.Write("run/frames.jsonl", "{}\n");
  EXPECT_THAT(ReadMessage(), HasSubstr("frames.jsonl:1: expected an object"));
  std::filesystem::remove(folder_ / "run/frames.jsonl");
  std::filesystem::copy_file(
      folder_ / "run/surfaces/000_background/motions.bin",
      folder_ / "run/surfaces/001_thin_plate/motions.bin",
      std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(ReadMessage(), HasSubstr("motions.bin has 1 nodes"));
  std::filesystem::remove(folder_ / "run/surfaces/001_thin_plate/mesh.ply");
  EXPECT_THAT(ReadMessage(), HasSubstr("mesh.ply: cannot be opened"));
  std::filesystem::create_directories(folder_ / "run/surfaces/notes");
  std::filesystem::remove_all(folder_ / "run/surfaces/001_thin_plate");
  EXPECT_THAT(ReadMessage(), HasSubstr("notes: expected a name NNN_LABEL"));
  folder_.Write("run/trajectory.txt", "# nothing\n");
  EXPECT_THAT(ReadMessage(), HasSubstr("trajectory.txt: no pose"));
  EXPECT_THAT(Message([&] { ReadRun(folder_ / "none"); }),
              HasSubstr("expected the directory of a run"));
}

TEST_F(FilesOfARun, FramesMustAscendAndFitTheTrajectory) {
  const std::string lines = folder_.Read("run/frames.jsonl");
  std::vector<std::string> reversed;
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) {
    reversed.insert(reversed.begin(), line);
  }
  std::string text;
  for (const std::string& line : reversed) text += line + "\n";
  folder_.Write("run/frames.jsonl", text);
  EXPECT_THAT(ReadMessage(),
              HasSubstr("frames.jsonl:2: frame 10: expected 12"));
  folder_.Write("run/frames.jsonl",
                R"({"frame": 0, "stem": "stem0", "timestamp": 999.5})" +
                    lines.substr(lines.find('\n')));
  EXPECT_THAT(ReadMessage(), HasSubstr("frames.jsonl:1: timestamp 999.5"));
  folder_.Write("run/frames.jsonl", R"({"frame": -1, "stem": "stem0"})" +
                                        lines.substr(lines.find('\n')));
  EXPECT_THAT(ReadMessage(), HasSubstr("frames.jsonl:1: frame -1: expected 0"));
}

TEST_F(FilesOfARun, VolumesThatAreNoneAreNoticed) {
  const std::string file = "run/surfaces/001_thin_plate/tsdf.vdb";
  for (const std::string& text :
       {std::string(), std::string("garbage and more of it"),
        std::string(" BDV")}) {
    folder_.Write(file, text);
    EXPECT_THAT(ReadMessage(), HasSubstr("tsdf.vdb: expected an OpenVDB file"));
  }
  std::filesystem::remove(folder_ / file);
  EXPECT_THAT(ReadMessage(), HasSubstr("tsdf.vdb: cannot be opened"));
}

TEST_F(FilesOfARun, DamagedMotionsAreNoticed) {
  const std::string file = "run/surfaces/001_thin_plate/motions.bin";
  const std::string bytes = folder_.Read(file);
  for (std::size_t at = 0; at < bytes.size(); at += bytes.size() / 300) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    folder_.Write(file, damaged);
    EXPECT_THAT(ReadMessage(), AllOf(HasSubstr("001_thin_plate/motions.bin"),
                                     Not(HasSubstr("\n"))))
        << "byte " << at;
  }
}

TEST_F(FilesOfARun, TracksAreCheckedForTheirSize) {
  const std::string bytes = folder_.Read("gt/tracks.bin");
  const TrueTracks tracks = TrueTracks::Read(folder_ / "gt/tracks.bin");
  EXPECT_EQ(tracks.frames(), 12);
  EXPECT_EQ(tracks.points(), 25);
  EXPECT_EQ(tracks.VisibleCount(3), 25);
  folder_.Write("gt/tracks.bin", bytes.substr(0, bytes.size() - 1));
  EXPECT_THAT(Message([&] { TrueTracks::Read(folder_ / "gt/tracks.bin"); }),
              HasSubstr("bytes: expected " + std::to_string(bytes.size())));
  folder_.Write("gt/tracks.bin", "something else that is long enough");
  EXPECT_THAT(Message([&] { TrueTracks::Read(folder_ / "gt/tracks.bin"); }),
              HasSubstr("expected a track file"));
}

TEST_F(FilesOfARun, TracksOfUnknownPointsAreRejected) {
  const TrueTracks tracks = TrueTracks::Read(folder_ / "gt/tracks.bin");
  const std::vector<Rigid3d> poses(12, Rigid3d::Identity());
  EXPECT_THAT(Message([&] {
                CompareTracks({{25, 1, {0, 0, 1}}}, tracks, poses, 0);
              }),
              HasSubstr("track point id = 25: expected 0..24"));
  EXPECT_THAT(Message([&] {
                CompareTracks({{0, 12, {0, 0, 1}}}, tracks, poses, 0);
              }),
              HasSubstr("frame of a track point = 12"));
}

}  // namespace
}  // namespace splitfusion
