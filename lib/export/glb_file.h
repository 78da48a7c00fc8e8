#ifndef SPLITFUSION_LIB_EXPORT_GLB_FILE_H_
#define SPLITFUSION_LIB_EXPORT_GLB_FILE_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace splitfusion {

/// What the numbers of an array of glTF are for, beyond their type.
struct GlbArrayKind {
  /// Of one element: SCALAR, VEC3, VEC4, MAT4.
  std::string type = "SCALAR";
  /// Of the buffer view; 0: neither vertices (34962) nor indices (34963).
  int target = 0;
  bool normalized = false;  ///< Integers stand for 0..1.
  bool bounds = false;      ///< With `min` and `max` of every component.
};

/// A binary glTF 2.0 file that is put together: its JSON, and the arrays in its
/// one buffer.
class GlbFile {
 public:
  /// The JSON, without `accessors`, `bufferViews` and `buffers`.
  nlohmann::ordered_json json;

  /// Adds an array, its elements one after another; returns the index of its
  /// accessor. Elements must take multiples of four bytes.
  ///
  /// @throw InputError if the file becomes larger than glTF can say, 4 GiB.
  int Add(const std::vector<float>& values, const GlbArrayKind& kind);
  /// Adds an array of unsigned integers, see above.
  int Add(const std::vector<std::uint16_t>& values, const GlbArrayKind& kind);
  /// Adds an array of unsigned integers, see above.
  int Add(const std::vector<std::uint32_t>& values, const GlbArrayKind& kind);

  /// Appends `object` to the list `name` of the JSON; returns its index.
  int Append(const std::string& name, nlohmann::ordered_json object);

  /// Writes the file.
  ///
  /// @throw InputError if it cannot be written.
  void Write(const std::string& path) const;

 private:
  template <typename T>
  int AddArray(const std::vector<T>& values, int component_type,
               const GlbArrayKind& kind);

  nlohmann::ordered_json accessors_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json views_ = nlohmann::ordered_json::array();
  std::string bytes_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_GLB_FILE_H_
