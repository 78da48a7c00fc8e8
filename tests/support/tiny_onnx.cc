#include "support/tiny_onnx.h"

#include <cstdlib>
#include <stdexcept>

#include "support/repository.h"

namespace splitfusion {
namespace {

constexpr char kPython[] = "/usr/bin/python3";  // Debian's, which has onnx.

}  // namespace

bool CanMakeTinyOnnx() {
  const std::string command =
      std::string(kPython) + " -c 'import onnx' 2>/dev/null";
  return std::system(command.c_str()) == 0;
}

std::string MakeTinyOnnx(const std::string& kind, const std::string& path) {
  const std::string script =
      (RepositoryRoot() / "tests/support/make_onnx.py").string();
  const std::string command =
      std::string(kPython) + " '" + script + "' " + kind + " '" + path + "'";
  if (std::system(command.c_str()) != 0) {
    throw std::runtime_error(command + " failed");
  }
  return path;
}

}  // namespace splitfusion
