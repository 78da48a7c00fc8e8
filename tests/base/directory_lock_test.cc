#include "splitfusion/lib/base/directory_lock.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// Silent from the first moment on.
LockOptions NoPatience() {
  return {std::chrono::milliseconds(5), std::chrono::milliseconds(-1)};
}

nlohmann::json Changed(const TemporaryFolder& folder, const std::string& key,
                       const nlohmann::json& value) {
  nlohmann::json lock = nlohmann::json::parse(folder.Read("lock"));
  lock[key] = value;
  folder.Write("lock", lock.dump());
  return lock;
}

/// The lock of a process that lives: this one.
void LeaveLock(const TemporaryFolder& folder) {
  const auto lock = DirectoryLock::TryAcquire(folder / "lock");
  ASSERT_TRUE(lock);
  const std::string text = folder.Read("lock");
  folder.Write("kept", text);
}

TEST(DirectoryLock, ExcludesOthersUntilItIsReleased) {
  const TemporaryFolder folder;
  {
    const auto lock = DirectoryLock::TryAcquire(folder / "lock");
    ASSERT_TRUE(lock);
    EXPECT_TRUE(lock->IsHeld());
    LockHolder holder;
    EXPECT_FALSE(DirectoryLock::TryAcquire(folder / "lock", &holder));
    EXPECT_EQ(holder.pid, getpid());
    EXPECT_TRUE(LivingHolder(folder / "lock"));
  }
  EXPECT_FALSE(folder.Has("lock"));
  EXPECT_FALSE(LivingHolder(folder / "lock"));
  EXPECT_TRUE(DirectoryLock::TryAcquire(folder / "lock"));
}

TEST(DirectoryLock, OfAProcessThatIsGoneIsTakenOver) {
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    const auto lock = DirectoryLock::TryAcquire(folder / "lock");
    _exit(lock ? 0 : 1);  // Without a destructor, as if killed.
  }
  int status = 1;
  waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
  ASSERT_TRUE(folder.Has("lock"));
  EXPECT_FALSE(LivingHolder(folder / "lock"));
  EXPECT_TRUE(DirectoryLock::TryAcquire(folder / "lock"));
}

TEST(DirectoryLock, OfAZombieIsTakenOver) {
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    auto lock = DirectoryLock::TryAcquire(folder / "lock");
    _exit(lock ? 0 : 1);  // As if killed: nothing is released.
  }
  siginfo_t info = {};
  ASSERT_EQ(waitid(P_PID, child, &info, WEXITED | WNOWAIT), 0);
  ASSERT_EQ(info.si_status, 0);
  EXPECT_FALSE(LivingHolder(folder / "lock"));
  EXPECT_TRUE(DirectoryLock::TryAcquire(folder / "lock"));
  EXPECT_EQ(waitpid(child, nullptr, 0), child);
}

TEST(DirectoryLock, OfAnotherProcessOfTheSameNumberIsTakenOver) {
  const TemporaryFolder folder;
  LeaveLock(folder);
  folder.Write("lock", folder.Read("kept"));
  EXPECT_FALSE(DirectoryLock::TryAcquire(folder / "lock"));
  Changed(folder, "process_start", 1);
  EXPECT_TRUE(DirectoryLock::TryAcquire(folder / "lock"));
}

TEST(DirectoryLock, OfBeforeARebootIsTakenOver) {
  const TemporaryFolder folder;
  LeaveLock(folder);
  folder.Write("lock", folder.Read("kept"));
  Changed(folder, "boot", "another");
  EXPECT_TRUE(DirectoryLock::TryAcquire(folder / "lock"));
}

TEST(DirectoryLock, OfAnotherHostIsTakenOverWhenItIsSilent) {
  const TemporaryFolder folder;
  LeaveLock(folder);
  folder.Write("lock", folder.Read("kept"));
  Changed(folder, "host", "elsewhere");
  Changed(folder, "pid", 1 << 29);  // Nothing that this host could know.
  EXPECT_FALSE(DirectoryLock::TryAcquire(folder / "lock"));
  EXPECT_TRUE(LivingHolder(folder / "lock"));
  EXPECT_TRUE(
      DirectoryLock::TryAcquire(folder / "lock", nullptr, NoPatience()));
}

TEST(DirectoryLock, ShowsSignsOfLife) {
  const TemporaryFolder folder;
  const auto lock =
      DirectoryLock::TryAcquire(folder / "lock", nullptr, NoPatience());
  ASSERT_TRUE(lock);
  const timespec old[2] = {{1, 0}, {1, 0}};
  utimensat(AT_FDCWD, (folder / "lock").c_str(), old, 0);
  struct stat state = {};
  for (int i = 0; i < 1000 && state.st_mtime <= 1; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    stat((folder / "lock").c_str(), &state);
  }
  EXPECT_GT(state.st_mtime, 1);
}

TEST(DirectoryLock, KnowsWhenItWasTakenAway) {
  const TemporaryFolder folder;
  const auto lock = DirectoryLock::TryAcquire(folder / "lock");
  ASSERT_TRUE(lock);
  std::filesystem::remove(folder / "lock");
  EXPECT_FALSE(lock->IsHeld());
  folder.Write("lock", "{\"id\": \"somebody else's\"}");
  EXPECT_FALSE(lock->IsHeld());
}

TEST(DirectoryLock, OneOfManyTakesAStaleOneOver) {
  const TemporaryFolder folder;
  LeaveLock(folder);
  for (int round = 0; round < 20; ++round) {
    folder.Write("lock", folder.Read("kept"));
    Changed(folder, "boot", "another");
    std::atomic<int> holders{0};
    std::atomic<int> most{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i) {
      threads.emplace_back([&] {
        const auto lock = DirectoryLock::TryAcquire(folder / "lock");
        if (!lock) return;
        const int now = ++holders;
        if (now > most) most = now;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        EXPECT_TRUE(lock->IsHeld());
        --holders;
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(most, 1);
  }
}

TEST(DirectoryLock, AFolderOfItsNameIsNamed) {
  const TemporaryFolder folder;
  folder.Write("lock/file", "");
  ExpectInputError([&] { DirectoryLock::TryAcquire(folder / "lock"); },
                   "lock: is a folder");
  EXPECT_FALSE(LivingHolder(folder / "lock"));
}

TEST(DirectoryLock, NeedsAFolder) {
  const TemporaryFolder folder;
  ExpectInputError([&] { DirectoryLock::TryAcquire(folder / "missing/lock"); },
                   "missing");
}

}  // namespace
}  // namespace splitfusion
