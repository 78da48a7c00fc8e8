#include "splitfusion/lib/base/spooled_list.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

namespace splitfusion {
namespace {

using Texts = std::vector<std::string>;

TEST(SpooledList, GivesBackWhatWasAddedInAnyOrder) {
  SpooledList<Texts> list;
  EXPECT_EQ(list.size(), 0);
  list.Add({"one", std::string(3000000, 'x')});
  list.Add({});
  list.Add({"three"});
  ASSERT_EQ(list.size(), 3);
  EXPECT_EQ(list.At(2), Texts({"three"}));
  EXPECT_EQ(list.At(0)[1].size(), 3000000u);
  EXPECT_EQ(list.At(1), Texts());
  EXPECT_EQ(list.At(0)[0], "one");
}

TEST(SpooledList, SeveralShareAFile) {
  const auto file = std::make_shared<SpoolFile>();
  SpooledList<Texts> a(file), b(file);
  a.Add({"a"});
  b.Add({"b"});
  a.Add({"c"});
  EXPECT_EQ(a.At(1), Texts({"c"}));
  EXPECT_EQ(b.At(0), Texts({"b"}));
}

TEST(SpooledList, GoesOnAfterACheckpoint) {
  SpooledList<Texts> list;
  list.Add({"a", "b"});
  list.Add({"c"});
  std::stringstream stream;
  ArchiveWriter writer(&stream);
  writer(list);
  writer.Flush();
  SpooledList<Texts> other;
  other.Add({"of before"});
  ArchiveReader reader(&stream, stream.str().size(), "checkpoint");
  reader(other);
  ASSERT_EQ(other.size(), 2);
  EXPECT_EQ(other.At(0), Texts({"a", "b"}));
  EXPECT_EQ(other.At(1), Texts({"c"}));
}

}  // namespace
}  // namespace splitfusion
