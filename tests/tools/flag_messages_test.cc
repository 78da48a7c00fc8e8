// What the tools say of values that are out of their range: the flag as typed.

#include <gtest/gtest.h>

#include "support/expect_refused.h"
#include "support/program.h"

namespace splitfusion {
namespace {

class FlagMessages : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* program :
         {"sf_batch", "sf_evaluate", "sf_montage", "sf_run", "sf_synth"}) {
      if (!HasProgram(program)) GTEST_SKIP() << program << " is not built";
    }
  }
  /// Options are checked before anything is read.
  static void RunRefuses(const std::string& option, const std::string& text) {
    ExpectRefused("sf_run", "--sequence=none --output=none " + option, text);
  }
};

TEST_F(FlagMessages, NameTheFlagWhereTheOptionHasAnotherName) {
  RunRefuses("--background_voxel=-1",
             "--background_voxel = -1: expected 0.001");
  RunRefuses("--object_voxel=1.5", "--object_voxel = 1.5: expected 0.001..1");
  RunRefuses("--background_voxel=0.0009",
             "--background_voxel = 9e-04: expected 0.001..1 metres, not 1");
  RunRefuses("--object_voxel=1e-9",
             "--object_voxel = 1e-09: expected 0.001..1 metres, not 1");
  RunRefuses("--background_truncation=0.01",
             "--background_truncation = 0.01: expected 2 to 50 voxels");
  RunRefuses("--object_voxel=0.02", "--object_truncation = 0.03: expected 2 ");
  RunRefuses("--object_truncation=10", "--object_truncation = 10: expected 2 ");
  RunRefuses("--max_depth=1e9", "--max_depth = 1e+09: expected 0..100 metres");
  RunRefuses("--object_min_piece=-1", "--object_min_piece = -1: expected squ");
  RunRefuses("--solver_iterations=0", "--solver_iterations = 0: expected");
  RunRefuses("--linear_iterations=0", "--linear_iterations = 0: expected");
  RunRefuses("--rigid_distance=0", "--rigid_distance = 0: expected metres");
  RunRefuses("--non_rigid_distance=0", "--non_rigid_distance = 0: expected");
}

TEST_F(FlagMessages, NameTheFlagOfAnOptionOfTheSameName) {
  RunRefuses("--render_stride=3", "--render_stride = 3: expected a divisor");
  RunRefuses("--max_nodes=0", "--max_nodes = 0: expected nodes >= 1");
  RunRefuses("--far_spacing=0.01",
             "--far_spacing = 0.01: expected metres >= near_spacing");
  RunRefuses("--min_score=2", "--min_score = 2: expected 0..1");
  RunRefuses("--rigid_objects=yes",
             "--rigid_objects = yes: expected background or separate");
  RunRefuses("--merge_touching=person",
             "--merge_touching = person: expected entries of at least two");
  RunRefuses("--intrinsics=0,1,1,1,64,48", "--intrinsics=0,1,1,1,64,48: camer");
  ExpectRefused("sf_batch", "run --jobs=0 --sequences=. --output=none",
                "--jobs = 0: expected 1..");
  ExpectRefused("sf_synth", "--output=none --scene=moon",
                "--scene = moon: expected one of room_person");
  ExpectRefused("sf_evaluate", "--run=none --depth_every=-1",
                "--depth_every = -1: expected");
}

TEST_F(FlagMessages, NameTheTermsAndWhatIsWrongInThem) {
  RunRefuses("--terms='arap(weight=-1)'",
             "--terms: arap.weight = -1: expected >= 0");
  RunRefuses("--terms='arap(scale=x)'", "--terms: arap.scale = x: expected");
  RunRefuses("--terms='arap(loss=none)'",
             "--terms: arap.loss = none: expected trivial, huber,");
  RunRefuses("--terms='arap(wait=1)'", "--terms: key 'wait' of term 'arap'");
  RunRefuses("--terms=arab", "--terms: term = arab: expected point_to_plane");
  RunRefuses("--terms=",
             "--terms is empty: expected one or more of point_to_plane");
}

TEST_F(FlagMessages, SayAnglesInTheFlagsUnit) {
  RunRefuses("--rigid_angle=200",
             "--rigid_angle = 200: expected 0..180 degrees, not 0");
  RunRefuses("--non_rigid_angle=-5",
             "--non_rigid_angle = -5: expected 0..180 degrees, not 0");
}

TEST_F(FlagMessages, NumbersThatNoMachineCouldServeAreRefused) {
  RunRefuses("--threads=100000000", "--threads = 100000000: expected 1..1024");
  RunRefuses("--threads=-1", "--threads = -1: expected 1..1024, or 0");
  RunRefuses("--solver_threads=2000000000", "--solver_threads = 2000000000");
  ExpectRefused("sf_batch", "run --jobs=100000000 --sequences=. --output=none",
                "--jobs = 100000000: expected 1..1024");
  ExpectRefused("sf_evaluate", "--run=none --samples=2000000000",
                "--samples = 2000000000: expected 1..");
  ExpectRefused("sf_evaluate", "--run=none --track_frames=2000000000",
                "--track_frames = 2000000000: expected 1..");
}

}  // namespace
}  // namespace splitfusion
