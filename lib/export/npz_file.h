#ifndef SPLITFUSION_LIB_EXPORT_NPZ_FILE_H_
#define SPLITFUSION_LIB_EXPORT_NPZ_FILE_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace splitfusion {

/// Receives the arrays of a file for NumPy.
class NpzArrays {
 public:
  /// Sizes of an array, the slowest index first.
  using Shape = std::vector<std::size_t>;

  /// `zip`: of minizip, open; stays with the caller.
  explicit NpzArrays(void* zip) : zip_(zip) {}

  /// Adds an array of `shape`, which must fit `values`; the one of the name
  /// "a/b" is `numpy.load(FILE)["a/b"]`.
  ///
  /// @throw InputError if it cannot be written.
  void Add(const std::string& name, const Shape& shape,
           const std::vector<float>& values);
  /// The same, double precision.
  void Add(const std::string& name, const Shape& shape,
           const std::vector<double>& values);
  /// The same, integers.
  void Add(const std::string& name, const Shape& shape,
           const std::vector<std::int32_t>& values);
  /// The same, bytes.
  void Add(const std::string& name, const Shape& shape,
           const std::vector<std::uint8_t>& values);

 private:
  template <typename T>
  void AddArray(const std::string& name, const std::string& type,
                const Shape& shape, const std::vector<T>& values);

  void* zip_;
};

/// Writes a file of arrays, a zip of .npy files that are not compressed;
/// `fill` adds them, and each is written at once. The same arrays give the same
/// bytes.
///
/// @throw InputError if it cannot be written.
void WriteNpz(const std::string& path,
              const std::function<void(NpzArrays*)>& fill);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_NPZ_FILE_H_
