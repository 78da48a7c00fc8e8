#ifndef SPLITFUSION_TESTS_SUPPORT_ENVIRONMENT_H_
#define SPLITFUSION_TESTS_SUPPORT_ENVIRONMENT_H_

#include <stdlib.h>

#include <map>
#include <string>

namespace splitfusion {

/// Environment variables of the programs that a test starts, while it lives.
class Environment {
 public:
  explicit Environment(const std::map<std::string, std::string>& variables)
      : variables_(variables) {
    for (const auto& [name, value] : variables_) {
      setenv(name.c_str(), value.c_str(), /*overwrite=*/1);
    }
  }
  ~Environment() {
    for (const auto& [name, value] : variables_) unsetenv(name.c_str());
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::map<std::string, std::string> variables_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_ENVIRONMENT_H_
