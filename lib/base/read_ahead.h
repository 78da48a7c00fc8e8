#ifndef SPLITFUSION_LIB_BASE_READ_AHEAD_H_
#define SPLITFUSION_LIB_BASE_READ_AHEAD_H_

#include <functional>
#include <future>
#include <optional>
#include <utility>

namespace splitfusion {

/// Makes the next one of a series while the last one is being worked on. The
/// series is the same as without; what its source throws is thrown when the
/// item is asked for.
template <typename Item>
class ReadAhead {
 public:
  /// `next` gives the next item, or none after the last; it runs on another
  /// thread, one call at a time. `ahead` false: it runs when asked for.
  ReadAhead(std::function<std::optional<Item>()> next, bool ahead)
      : next_(std::move(next)), ahead_(ahead) {}

  /// The next item; empty after the last one.
  std::optional<Item> Next() {
    if (!ahead_) return next_();
    if (!pending_.valid()) Start();
    std::optional<Item> item = pending_.get();
    if (item) Start();
    return item;
  }

 private:
  void Start() { pending_ = std::async(std::launch::async, next_); }

  std::function<std::optional<Item>()> next_;
  bool ahead_;
  std::future<std::optional<Item>> pending_;  // Waits when destroyed.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_READ_AHEAD_H_
