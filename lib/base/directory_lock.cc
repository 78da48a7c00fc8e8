#include "splitfusion/lib/base/directory_lock.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/random_id.h"

namespace splitfusion {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LockHolder, id, host, boot, pid,
                                   process_start)

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string FirstWord(const std::string& path) {
  std::ifstream stream(path);
  std::string word;
  stream >> word;
  return word;
}

/// What the kernel says of a process.
struct ProcessState {
  long long start = 0;  ///< Clock ticks since the boot; 0: no such process.
  bool ends = false;    ///< It was killed or has returned, but is still there.
  bool ended = false;   ///< Only an entry is left, for its parent to look at.
};

/// From /proc/PID/stat, see proc(5).
ProcessState StateOf(long pid) {
  std::ifstream stream("/proc/" + std::to_string(pid) + "/stat");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream words(text.substr(name_end + 1));
  const std::vector<std::string> fields{
      std::istream_iterator<std::string>(words), {}};
  const auto field = [&](std::size_t number) {  // Counted from 1, as there.
    constexpr std::size_t kFirst = 3;
    const std::size_t i = number - kFirst;
    return i < fields.size() ? fields[i] : std::string("0");
  };
  constexpr long long kExiting = 4;  // PF_EXITING of the kernel.
  ProcessState state;
  state.start = std::atoll(field(22).c_str());
  const bool empty = field(3) == "Z" || field(3) == "X";
  state.ended = empty && std::atoll(field(20).c_str()) <= 1;  // No threads.
  state.ends = empty || (std::atoll(field(9).c_str()) & kExiting) != 0;
  return state;
}

LockHolder ThisProcess() {
  LockHolder self;
  self.id = RandomId();
  self.host = HostName();
  self.boot = FirstWord("/proc/sys/kernel/random/boot_id");
  self.pid = getpid();
  self.process_start = StateOf(self.pid).start;
  return self;
}

std::string ToText(const LockHolder& holder) {
  return Json(holder).dump() + "\n";
}

/// Empty for what is no file.
std::string ReadAll(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return "";
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Empty for what is no lock, such as one whose writer is still at it.
std::optional<LockHolder> Parse(const std::string& text) {
  try {
    return Json::parse(text).get<LockHolder>();
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

/// Age of a file by the clock of its file system, which hosts that share it
/// agree on; zero if that cannot be told.
std::chrono::milliseconds Age(const std::string& path) {
  const std::string probe = path + ".probe-" + RandomId();
  const int descriptor = open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0644);
  if (descriptor < 0) return std::chrono::milliseconds(0);
  close(descriptor);
  struct stat now = {}, then = {};
  const bool known =
      stat(probe.c_str(), &now) == 0 && stat(path.c_str(), &then) == 0;
  unlink(probe.c_str());
  if (!known) return std::chrono::milliseconds(0);
  return std::chrono::milliseconds(
      (now.st_mtim.tv_sec - then.st_mtim.tv_sec) * 1000 +
      (now.st_mtim.tv_nsec - then.st_mtim.tv_nsec) / 1000000);
}

bool IsStale(const std::string& path, const std::string& text,
             const LockOptions& options) {
  const std::optional<LockHolder> holder = Parse(text);
  if (!holder) return Age(path) > options.silence;  // Half of a lock.
  const LockHolder self = ThisProcess();
  if (holder->host != self.host) return Age(path) > options.silence;
  if (holder->boot != self.boot) return true;
  // A process that is ending stops writing soon; it is waited for.
  constexpr int kLooks = 500;
  constexpr std::chrono::milliseconds kBetween(10);
  ProcessState state = StateOf(holder->pid);
  for (int i = 0; i < kLooks && state.ends && !state.ended; ++i) {
    std::this_thread::sleep_for(kBetween);
    state = StateOf(holder->pid);
  }
  return state.ended || state.start != holder->process_start;
}

/// False if a file of that name is there already.
bool CreateExclusively(const std::string& path, const std::string& text) {
  const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0644);
  if (descriptor < 0 && errno == EEXIST) return false;
  const bool written =
      descriptor >= 0 && write(descriptor, text.data(), text.size()) ==
                             static_cast<ssize_t>(text.size());
  const std::string reason = std::strerror(errno);
  if (descriptor >= 0) close(descriptor);
  if (written) return true;
  if (descriptor >= 0) unlink(path.c_str());
  throw InputError(path + ": cannot be written (" + reason + ")");
}

/// Removes a stale lock unless it has changed meanwhile. A second lock is held
/// for that, so that the lock of a process that came first is not removed.
void RemoveStale(const std::string& path, const std::string& text,
                 const LockOptions& options) {
  const std::string guard = path + ".takeover";
  if (!CreateExclusively(guard, ToText(ThisProcess()))) {
    if (IsStale(guard, ReadAll(guard), options)) unlink(guard.c_str());
    return;
  }
  if (ReadAll(path) == text) unlink(path.c_str());
  unlink(guard.c_str());
}

}  // namespace

std::string HostName() {
  char name[256] = {};
  gethostname(name, sizeof(name) - 1);
  return name;
}

std::string LockHolder::ToString() const {
  if (id.empty()) return "a lock without a name";
  return "process " + std::to_string(pid) + " on " + host;
}

/// Touches the file until it is destroyed.
class DirectoryLock::Heartbeat {
 public:
  Heartbeat(std::string path, std::chrono::milliseconds interval)
      : path_(std::move(path)), thread_([this, interval] { Beat(interval); }) {}
  ~Heartbeat() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ended_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

 private:
  void Beat(std::chrono::milliseconds interval) {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!wake_.wait_for(lock, interval, [this] { return ended_; })) {
      utimensat(AT_FDCWD, path_.c_str(), nullptr, 0);
    }
  }

  const std::string path_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool ended_ = false;
  std::thread thread_;  // Last: it uses the others.
};

std::optional<DirectoryLock> DirectoryLock::TryAcquire(
    const std::string& path, LockHolder* holder, const LockOptions& options) {
  const LockHolder self = ThisProcess();
  constexpr int kTries = 3;  // Others may take a stale lock over first.
  for (int i = 0; i < kTries; ++i) {
    if (CreateExclusively(path, ToText(self))) {
      return DirectoryLock(path, self.id, options);
    }
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
      throw InputError(path + ": is a folder: expected a lock file, or none");
    }
    const std::string text = ReadAll(path);
    if (!IsStale(path, text, options)) break;
    RemoveStale(path, text, options);
  }
  if (holder != nullptr) *holder = Parse(ReadAll(path)).value_or(LockHolder());
  return std::nullopt;
}

DirectoryLock::DirectoryLock(std::string path, std::string id,
                             const LockOptions& options)
    : path_(std::move(path)),
      id_(std::move(id)),
      heartbeat_(std::make_unique<Heartbeat>(path_, options.heartbeat)) {}

DirectoryLock::~DirectoryLock() { Release(); }

DirectoryLock::DirectoryLock(DirectoryLock&&) noexcept = default;

DirectoryLock& DirectoryLock::operator=(DirectoryLock&& other) noexcept {
  if (this == &other) return *this;
  Release();
  path_ = std::move(other.path_);
  id_ = std::move(other.id_);
  heartbeat_ = std::move(other.heartbeat_);
  return *this;
}

void DirectoryLock::Release() {
  if (!heartbeat_) return;  // Moved from.
  heartbeat_.reset();
  if (IsHeld()) unlink(path_.c_str());
}

bool DirectoryLock::IsHeld() const {
  const std::optional<LockHolder> holder = Parse(ReadAll(path_));
  return holder && holder->id == id_;
}

std::optional<LockHolder> LivingHolder(const std::string& path,
                                       const LockOptions& options) {
  const std::string text = ReadAll(path);
  if (text.empty() || IsStale(path, text, options)) return std::nullopt;
  return Parse(text);
}

}  // namespace splitfusion
