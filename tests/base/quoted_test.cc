#include "splitfusion/lib/base/quoted.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

TEST(Quoted, PlainTextIsAsItIs) {
  EXPECT_EQ(Quoted("max_frames = 1"), "'max_frames = 1'");
  EXPECT_EQ(Quoted(""), "''");
  EXPECT_EQ(Quoted("Stühle 椅子"), "'Stühle 椅子'");
}

TEST(Quoted, ControlCharactersAndOddBytesAreEscaped) {
  EXPECT_EQ(Quoted("a\tb\r\x1b[2J\x7f"), "'a\\x09b\\x0d\\x1b[2J\\x7f'");
  EXPECT_EQ(Quoted(std::string("\0", 1)), "'\\x00'");
  EXPECT_EQ(Quoted("\xff\xc3("), "'\\xff\\xc3('");
  EXPECT_EQ(Quoted("\xe6\xa4"), "'\\xe6\\xa4'") << "a character cut short";
  EXPECT_EQ(Quoted("\xc2\x9b"), "'\\xc2\\x9b'");
}

TEST(Quoted, LongTextIsShortened) {
  const std::string quoted = Quoted(std::string(20000000, 'x'));
  EXPECT_LT(quoted.size(), 80u);
  EXPECT_EQ(quoted.substr(quoted.size() - 5), "x...'");
  EXPECT_LT(Quoted(std::string(1000, '\x01')).size(), 80u);
}

}  // namespace
}  // namespace splitfusion
