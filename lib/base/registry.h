#ifndef SPLITFUSION_LIB_BASE_REGISTRY_H_
#define SPLITFUSION_LIB_BASE_REGISTRY_H_

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/any_of.h"
#include "splitfusion/lib/base/error.h"

namespace splitfusion {

/// What an option may name, an extension point: makes a Product from Arguments
/// by its name. A plain value: take the built-in one, register your own beside
/// it, pass it on.
template <typename Product, typename... Arguments>
class Registry {
 public:
  /// Makes one.
  using Factory = std::function<std::unique_ptr<Product>(Arguments...)>;

  /// `kind`: of what it makes, as the option is called: "solver".
  explicit Registry(std::string kind) : kind_(std::move(kind)) {}

  /// @throw InputError if the name is taken.
  void Register(const std::string& name, Factory factory) {
    if (Find(name) != entries_.end()) {
      throw InputError(kind_ + " '" + name + "': already registered");
    }
    entries_.emplace_back(name, std::move(factory));
  }

  /// @throw OptionError on an unknown name; lists the known ones.
  std::unique_ptr<Product> Make(const std::string& name,
                                Arguments... arguments) const {
    Check(name);
    return Find(name)->second(std::forward<Arguments>(arguments)...);
  }

  /// @throw OptionError on an unknown name; lists the known ones.
  void Check(const std::string& name) const {
    CheckOption(Find(name) != entries_.end(), kind_, name.empty() ? "''" : name,
                AnyOf(names()));
  }

  /// Registered names, in the order of registration.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& [name, factory] : entries_) names.push_back(name);
    return names;
  }

 private:
  using Entry = std::pair<std::string, Factory>;

  typename std::vector<Entry>::const_iterator Find(
      const std::string& name) const {
    return std::find_if(entries_.begin(), entries_.end(),
                        [&](const Entry& e) { return e.first == name; });
  }

  std::string kind_;
  std::vector<Entry> entries_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_REGISTRY_H_
