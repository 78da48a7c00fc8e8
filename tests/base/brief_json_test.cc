#include "splitfusion/lib/base/brief_json.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

using nlohmann::json;

std::string Brief(const std::string& text) {
  return BriefJson(json::parse(text));
}

TEST(BriefJson, SmallValuesAreWhole) {
  EXPECT_EQ(Brief(R"({"index": 0, "box": [1, 2.5, null]})"),
            R"({"box":[1,2.5,null],"index":0})");
  EXPECT_EQ(Brief("\"a\\nb\""), "\"a\\nb\"");
  EXPECT_EQ(Brief("[]"), "[]");
}

TEST(BriefJson, DeepAndLongOnesAreCut) {
  EXPECT_EQ(Brief(std::string(100000, '[') + std::string(100000, ']')),
            "[[[[...]]]]");
  EXPECT_LT(BriefJson(json(std::string(100000, 'x'))).size(), 300u);
  EXPECT_LT(BriefJson(json(std::vector<int>(100000, 7))).size(), 300u);
}

}  // namespace
}  // namespace splitfusion
