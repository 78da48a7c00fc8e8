#include "splitfusion/lib/base/content_hash.h"

#include <gtest/gtest.h>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

TEST(ContentHash, IsTheOneThatXxh128sumPrints) {
  const TemporaryFolder folder;
  // printf abc | xxh128sum
  EXPECT_EQ(HashOfFile(folder.Write("abc", "abc")),
            "06b05ab6733a618578af5f94892f3950");
}

TEST(ContentHash, DependsOnAllBytesAndNotOnThePieces) {
  ContentHash whole, pieces, other;
  whole.Add("abcdef", 6);
  pieces.Add("abc", 3).Add("def", 3);
  other.Add("abcdeg", 6);
  EXPECT_EQ(whole.Hex(), pieces.Hex());
  EXPECT_NE(whole.Hex(), other.Hex());
}

TEST(RunningChecksum64, IsThatOfAllBytes) {
  std::string bytes(3000, 'x');
  bytes[1234] = 'y';
  RunningChecksum64 running;
  EXPECT_EQ(running.Value(), Checksum64(nullptr, 0));
  running.Add(bytes.data(), 1);
  running.Add(bytes.data() + 1, 1999);
  running.Add(bytes.data() + 2000, 1000);
  EXPECT_EQ(running.Value(), Checksum64(bytes.data(), bytes.size()));
  EXPECT_NE(running.Value(), Checksum64(bytes.data(), bytes.size() - 1));
}

TEST(ContentHash, TextsAreToldApartByWhereTheyEnd) {
  ContentHash a, b;
  a.Add(std::string("ab")).Add(std::string("c"));
  b.Add(std::string("a")).Add(std::string("bc"));
  EXPECT_NE(a.Hex(), b.Hex());
}

TEST(HashOfFile, NamesWhatCannotBeRead) {
  const TemporaryFolder folder;
  ExpectInputError([&] { HashOfFile(folder / "none"); }, "none");
  ExpectInputError([&] { HashOfFile(folder / ""); }, "expected a file");
}

}  // namespace
}  // namespace splitfusion
