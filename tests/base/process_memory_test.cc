#include "splitfusion/lib/base/process_memory.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <vector>

namespace splitfusion {
namespace {

/// Pages that the system gives while so many bytes are filled and freed.
long FreshPages(std::size_t bytes) {
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  const std::vector<char> filled(bytes, 1);
  getrusage(RUSAGE_SELF, &after);
  EXPECT_EQ(filled.back(), 1);
  return after.ru_minflt - before.ru_minflt;
}

TEST(KeepFreedMemory, WhatWasFreedIsUsedAgain) {
#if defined(__SANITIZE_ADDRESS__) || !defined(__GLIBC__)
  GTEST_SKIP() << "not glibc's memory";
#endif
  constexpr std::size_t kBytes = 24 << 20;
  KeepFreedMemory();
  EXPECT_GT(FreshPages(kBytes), 0);
  EXPECT_LT(FreshPages(kBytes), 100);  // Of some 6,000.
  ReturnFreedMemory();
  EXPECT_GT(FreshPages(kBytes), 1000);
}

}  // namespace
}  // namespace splitfusion
