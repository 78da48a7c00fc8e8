// The examples run by themselves and say what they promise.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;

ProgramResult RunExample(const std::string& name,
                         const std::string& arguments = "") {
  const ProgramResult result = RunProgram(name, arguments);
  EXPECT_EQ(result.exit_code, 0) << result.output << result.errors;
  return result;
}

#define SKIP_WITHOUT(name) \
  if (!HasProgram(name)) GTEST_SKIP() << (name) << " is not built"

TEST(Examples, ReconstructSequence) {
  SKIP_WITHOUT("01_reconstruct_sequence");
  const TemporaryFolder folder;
  ASSERT_EQ(RunProgram("sf_synth",
                       "--width=160 --height=120 --frames=3 "
                       "--output=" +
                           (folder / "sequence"))
                .exit_code,
            0);
  RunExample("01_reconstruct_sequence",
             (folder / "sequence") + " " + (folder / "output"));
  EXPECT_TRUE(folder.Has("output/trajectory.txt"));
  EXPECT_TRUE(folder.Has("output/000_background.ply"));
  EXPECT_TRUE(folder.Has("output/001_person.ply"));
  EXPECT_EQ(RunProgram("01_reconstruct_sequence", folder / "none").exit_code,
            2);
}

TEST(Examples, CustomEnergyTerm) {
  SKIP_WITHOUT("02_custom_energy_term");
  EXPECT_THAT(RunExample("02_custom_energy_term").output,
              HasSubstr("landmark: cost"));
}

TEST(Examples, CustomDataSet) {
  SKIP_WITHOUT("03_custom_data_set");
  const TemporaryFolder folder;
  const std::string output =
      RunExample("03_custom_data_set", folder / "room").output;
  EXPECT_THAT(output, HasSubstr("15 frames, format room"));
  EXPECT_THAT(output, HasSubstr("mesh of the room"));
}

}  // namespace
}  // namespace splitfusion
