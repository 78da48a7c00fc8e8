#include "splitfusion/lib/segmentation/label_table.h"

#include <gtest/gtest.h>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

TEST(LabelTable, TreatsPeopleAndAnimalsAsNonRigid) {
  const LabelTable table;
  for (const char* name : {"person", "dog", "teddy bear", "umbrella", "tie",
                           "giraffe", "object"}) {
    EXPECT_EQ(table.Kind(name), SurfaceKind::kNonRigid) << name;
  }
  for (const char* name : {"chair", "tv", "kite", "rigid_object", "unheard"}) {
    EXPECT_EQ(table.Kind(name), SurfaceKind::kRigid) << name;
  }
}

TEST(LabelTable, IsEditedByAFile) {
  const TemporaryFolder folder;
  const LabelTable table = LabelTable::FromFile(folder.Write(
      "labels.txt", "# mine\n\nkite, non_rigid\n teddy bear ,rigid  # toy\n"));
  EXPECT_EQ(table.Kind("kite"), SurfaceKind::kNonRigid);
  EXPECT_EQ(table.Kind("teddy bear"), SurfaceKind::kRigid);
  EXPECT_EQ(table.Kind("person"), SurfaceKind::kNonRigid);
}

TEST(LabelTable, KnowsCocoAndWhatItWasTold) {
  const TemporaryFolder folder;
  const LabelTable table = LabelTable::FromFile(
      folder.Write("labels.txt", "robot, rigid\nsnake, non_rigid\n"));
  for (const char* name :
       {"person", "chair", "toothbrush", "object", "robot", "snake"}) {
    EXPECT_TRUE(table.Knows(name)) << name;
  }
  EXPECT_FALSE(table.Knows("teddybear"));
  EXPECT_FALSE(LabelTable().Knows("robot"));
}

TEST(LabelTable, NamesTheBrokenLine) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    return [path = folder.Write("labels.txt", text)] {
      LabelTable::FromFile(path);
    };
  };
  ExpectInputError(read("kite, non_rigid\nchair\n"), "labels.txt:2: 'chair'");
  ExpectInputError(read("chair, stiff\n"), "labels.txt:1: 'chair, stiff'");
  ExpectInputError(read(", rigid\n"), "labels.txt:1");
  ExpectInputError([&] { LabelTable::FromFile(folder / "none"); },
                   "cannot be opened");
}

TEST(SurfaceKind, HasAWordForReports) {
  EXPECT_EQ(ToString(SurfaceKind::kRigid), "rigid");
  EXPECT_EQ(ToString(SurfaceKind::kNonRigid), "non_rigid");
}

}  // namespace
}  // namespace splitfusion
