#ifndef SPLITFUSION_TESTS_SUPPORT_TINY_ONNX_H_
#define SPLITFUSION_TESTS_SUPPORT_TINY_ONNX_H_

#include <string>

namespace splitfusion {

/// Whether tests can make networks (Debian's python3-onnx).
bool CanMakeTinyOnnx();

/// Writes the tiny network of that kind (see make_onnx.py) to `path` and
/// returns the path.
///
/// @throw std::runtime_error if the script fails.
std::string MakeTinyOnnx(const std::string& kind, const std::string& path);

}  // namespace splitfusion

/// Skips the test, and says so, where no network can be made.
#define SKIP_WITHOUT_TINY_ONNX()                                        \
  if (!::splitfusion::CanMakeTinyOnnx()) {                              \
    GTEST_SKIP() << "python3-onnx not found: install Debian's package"; \
  }

#endif  // SPLITFUSION_TESTS_SUPPORT_TINY_ONNX_H_
