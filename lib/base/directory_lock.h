#ifndef SPLITFUSION_LIB_BASE_DIRECTORY_LOCK_H_
#define SPLITFUSION_LIB_BASE_DIRECTORY_LOCK_H_

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace splitfusion {

/// Name of this machine.
std::string HostName();

/// Who holds a lock.
struct LockHolder {
  std::string id;    ///< Of this very lock.
  std::string host;  ///< Host name.
  std::string boot;  ///< Of the host's start; another one after a reboot.
  long pid = 0;      ///< Process.
  /// Start of the process in clock ticks since the boot, so that a process
  /// that got the same number later is told apart.
  long long process_start = 0;

  /// "process 4711 on host", for messages; "a lock without a name" if it is
  /// unknown, as of an empty file.
  std::string ToString() const;
};

/// How stale locks are told.
struct LockOptions {
  /// Between two signs of life.
  std::chrono::milliseconds heartbeat{5000};
  /// A holder on another host counts as gone after such a silence, measured by
  /// the clock of the file system that both share.
  std::chrono::milliseconds silence{120000};
};

/// A file that says that a process works in its folder. It names host, process
/// and its start, and is touched every few seconds while it is held. A lock
/// whose process is gone or a zombie, or on another host is silent for long, is
/// taken over.
class DirectoryLock {
 public:
  /// Takes the lock at `path` (the folder must exist). Empty while another one
  /// holds it, who is then put into `holder` (may be null).
  ///
  /// @throw InputError if the file cannot be written.
  static std::optional<DirectoryLock> TryAcquire(
      const std::string& path, LockHolder* holder = nullptr,
      const LockOptions& options = {});

  /// Removes the file if it is still ours.
  ~DirectoryLock();
  /// What it was moved from holds nothing.
  DirectoryLock(DirectoryLock&&) noexcept;
  /// As the constructor; releases what it held.
  DirectoryLock& operator=(DirectoryLock&&) noexcept;

  /// Whether the file is there and ours: not after the folder was removed, or
  /// another took the lock over while this process was stopped for long.
  bool IsHeld() const;

 private:
  class Heartbeat;
  DirectoryLock(std::string path, std::string id, const LockOptions& options);
  void Release();

  std::string path_;
  std::string id_;
  std::unique_ptr<Heartbeat> heartbeat_;
};

/// The living holder of the lock at `path`; empty if there is none.
std::optional<LockHolder> LivingHolder(const std::string& path,
                                       const LockOptions& options = {});

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_DIRECTORY_LOCK_H_
