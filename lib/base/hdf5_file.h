#ifndef SPLITFUSION_LIB_BASE_HDF5_FILE_H_
#define SPLITFUSION_LIB_BASE_HDF5_FILE_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

namespace splitfusion {

/// How HDF5 keeps a number; in a file always with the lowest byte first.
enum class Hdf5Number {
  kInt32,   ///< A whole number.
  kFloat,   ///< IEEE, 32 bits.
  kDouble,  ///< IEEE, 64 bits.
};

namespace internal {

template <typename T>
constexpr Hdf5Number NumberOf() {
  static_assert(std::is_same_v<T, std::int32_t> || std::is_same_v<T, float> ||
                std::is_same_v<T, double>);
  if constexpr (std::is_same_v<T, float>) return Hdf5Number::kFloat;
  if constexpr (std::is_same_v<T, double>) return Hdf5Number::kDouble;
  return Hdf5Number::kInt32;
}

/// A number, or numbers in a row or a matrix, as one item of a dataset.
template <typename T, typename = void>
struct Hdf5Item {
  using Number = T;
  static std::vector<std::uint64_t> Shape() { return {}; }
  static constexpr std::size_t kSize = 1;
  static T& At(T* item, std::size_t) { return *item; }
};
template <typename T, std::size_t N>
struct Hdf5Item<std::array<T, N>> {
  using Number = T;
  static std::vector<std::uint64_t> Shape() { return {N}; }
  static constexpr std::size_t kSize = N;
  static T& At(std::array<T, N>* item, std::size_t i) { return (*item)[i]; }
};
/// Matrices lie row by row, columns as rows of numbers.
template <typename T, int R, int C>
struct Hdf5Item<Eigen::Matrix<T, R, C>> {
  using Number = T;
  static std::vector<std::uint64_t> Shape() {
    if constexpr (C == 1) return {std::uint64_t{R}};
    return {std::uint64_t{R}, std::uint64_t{C}};
  }
  static constexpr std::size_t kSize = std::size_t{R} * C;
  static T& At(Eigen::Matrix<T, R, C>* item, std::size_t i) {
    return (*item)(static_cast<int>(i) / C, static_cast<int>(i) % C);
  }
};

}  // namespace internal

/// An HDF5 file in the making: attributes of the root, and datasets
/// that are named by paths, GROUP/NAME; those of a group have equally many
/// rows. Written with a checksum of every dataset and of all that describes it,
/// without times: the same content has the same bytes. One function can serve
/// this and Hdf5Reader, see kReads.
class Hdf5Writer {
 public:
  /// Tells functions for both directions which one is asked for.
  static constexpr bool kReads = false;

  /// @throw InputError if the file cannot be made.
  explicit Hdf5Writer(const std::string& path);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// A text of the root.
  void Attribute(const std::string& name, std::string* text);
  /// A number of the root.
  void Attribute(const std::string& name, std::int32_t* value);
  /// A number of the root.
  void Attribute(const std::string& name, double* value);

  /// Whether something is there: says what `here` says.
  bool Has(const std::string& /*path*/, bool here) const { return here; }

  /// The dataset `path` of `of(item)` of every item: a number, std::array or
  /// Eigen matrix of fixed size, of std::int32_t, float or double.
  template <typename Item, typename Of>
  void Column(const std::string& path, std::vector<Item>* items, const Of& of) {
    using Value = std::remove_reference_t<decltype(of(items->front()))>;
    using Layout = internal::Hdf5Item<Value>;
    std::vector<typename Layout::Number> numbers;
    numbers.reserve(items->size() * Layout::kSize);
    for (Item& item : *items) {
      for (std::size_t i = 0; i < Layout::kSize; ++i) {
        numbers.push_back(Layout::At(&of(item), i));
      }
    }
    std::vector<std::uint64_t> shape = Layout::Shape();
    shape.insert(shape.begin(), items->size());
    Write(path, internal::NumberOf<typename Layout::Number>(), shape,
          numbers.data());
  }

  /// The items themselves.
  template <typename Item>
  void Column(const std::string& path, std::vector<Item>* items) {
    Column(path, items, [](Item& item) -> Item& { return item; });
  }

  /// Closes the file.
  ///
  /// @throw InputError if something could not be written.
  void Close();

 private:
  void Write(const std::string& path, Hdf5Number number,
             const std::vector<std::uint64_t>& shape, const void* numbers);
  void MakeGroup(const std::string& name);
  void WriteAttribute(const std::string& name, std::int64_t type,
                      const void* value);

  [[noreturn]] void Fail() const;

  std::string path_;
  std::int64_t file_ = -1;  // HDF5's identifiers are 64-bit numbers.
};

/// Reads what an Hdf5Writer wrote, or another program in the same form.
/// Everything is checked before room is made for it.
class Hdf5Reader {
 public:
  /// Tells functions for both directions which one is asked for.
  static constexpr bool kReads = true;

  /// @throw InputError if there is no such file, or it is no HDF5 file.
  explicit Hdf5Reader(const std::string& path);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  /// @throw InputError if the root has no such attribute of this kind.
  void Attribute(const std::string& name, std::string* text);
  /// As of a text.
  void Attribute(const std::string& name, std::int32_t* value);
  /// As of a text.
  void Attribute(const std::string& name, double* value);

  /// Whether the file has a group or dataset of this path.
  bool Has(const std::string& path, bool here) const;

  /// Whether the root has an attribute of this name.
  bool HasAttribute(const std::string& name) const;

  /// Reads a dataset into `of(item)` of every item. The first column of a group
  /// makes the items; the others of the group must have as many.
  ///
  /// @throw InputError if the dataset is missing, damaged, of another shape or
  ///     kind of number, or a number in it is not finite.
  template <typename Item, typename Of>
  void Column(const std::string& path, std::vector<Item>* items, const Of& of) {
    using Value = std::remove_reference_t<decltype(of(items->front()))>;
    using Layout = internal::Hdf5Item<Value>;
    using Number = typename Layout::Number;
    const std::uint64_t rows =
        CheckedRows(path, internal::NumberOf<Number>(), Layout::Shape());
    std::vector<Number> numbers(rows * Layout::kSize);
    Read(path, internal::NumberOf<Number>(), numbers.size(), numbers.data());
    items->resize(rows);
    const Number* number = numbers.data();
    for (Item& item : *items) {
      for (std::size_t i = 0; i < Layout::kSize; ++i) {
        Layout::At(&of(item), i) = *number++;
      }
    }
  }

  /// The items themselves.
  template <typename Item>
  void Column(const std::string& path, std::vector<Item>* items) {
    Column(path, items, [](Item& item) -> Item& { return item; });
  }

  /// Throws an InputError that names the file.
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  std::uint64_t CheckedRows(const std::string& path, Hdf5Number number,
                            const std::vector<std::uint64_t>& item_shape);
  void Read(const std::string& path, Hdf5Number number, std::size_t count,
            void* numbers) const;
  void ReadAttribute(const std::string& name, std::int64_t type,
                     const std::string& kind, void* value) const;

  std::string path_;
  std::int64_t file_ = -1;
  std::map<std::string, std::uint64_t> rows_;  // By group.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_HDF5_FILE_H_
