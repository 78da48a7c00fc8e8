#ifndef SPLITFUSION_LIB_BASE_ARCHIVE_H_
#define SPLITFUSION_LIB_BASE_ARCHIVE_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <deque>
#include <iomanip>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/archive_stream.h"

namespace splitfusion {

// State in binary form, for the same program on the same kind of machine: an
// ArchiveWriter takes, and an ArchiveReader gives back bit for bit,
//  - numbers, truth values, enumerations, texts,
//  - Eigen's matrices of fixed size and transforms, cv::Vec, cv::Mat,
//  - vectors, deques, arrays, sets, maps, pairs and optionals of such,
//  - whatever has a member
//      template <typename Archive>
//      void Serialize(Archive* archive) { (*archive)(a_, b_); }
//    one function for both directions, so that they cannot get out of step. It
//    changes nothing unless Archive::kReads.

namespace internal {

template <typename T, typename = void>
struct IsEigenMatrix : std::false_type {};
template <typename T>
struct IsEigenMatrix<
    T, std::enable_if_t<std::is_base_of_v<Eigen::PlainObjectBase<T>, T>>>
    : std::bool_constant<T::SizeAtCompileTime != Eigen::Dynamic> {};

/// Whether a value is its bytes: no pointers, no padding, all patterns valid.
template <typename T>
struct IsPlain
    : std::bool_constant<(std::is_arithmetic_v<T> &&
                          !std::is_same_v<T, bool>) ||
                         std::is_enum_v<T> || IsEigenMatrix<T>::value> {};
template <typename T, std::size_t N>
struct IsPlain<std::array<T, N>> : IsPlain<T> {};
template <typename T, int N>
struct IsPlain<cv::Vec<T, N>> : IsPlain<T> {};

template <typename T, typename Archive, typename = void>
struct HasSerialize : std::false_type {};
template <typename T, typename Archive>
struct HasSerialize<T, Archive,
                    std::void_t<decltype(std::declval<T&>().Serialize(
                        std::declval<Archive*>()))>> : std::true_type {};

/// Writes or reads one value of any kind.
template <typename Archive, typename T>
void Visit(Archive* archive, T* value) {
  if constexpr (IsPlain<T>::value) {
    archive->Raw(value, sizeof(T));
  } else if constexpr (HasSerialize<T, Archive>::value) {
    value->Serialize(archive);
  } else {
    Serialize(archive, value);  // One of those below.
  }
}

/// Vectors and deques of what is not plain.
template <typename Archive, typename List>
void SerializeList(Archive* archive, List* values) {
  const std::uint64_t count = archive->Count(values->size(), 1);
  if constexpr (Archive::kReads) {
    values->clear();
    for (std::uint64_t i = 0; i < count; ++i)
      (*archive)(values->emplace_back());
  } else {
    for (const auto& value : *values) (*archive)(value);
  }
}

/// Sets and maps; `Value`: an element that can be assigned to.
template <typename Value, typename Archive, typename Tree>
void SerializeTree(Archive* archive, Tree* values) {
  const std::uint64_t count = archive->Count(values->size(), 1);
  if constexpr (Archive::kReads) {
    values->clear();
    for (std::uint64_t i = 0; i < count; ++i) {
      Value value{};
      (*archive)(value);
      values->emplace_hint(values->end(), std::move(value));
    }
  } else {
    for (const auto& value : *values) (*archive)(value);
  }
}

/// Type of the elements of a cv::Mat_; -1: of any.
inline int ElementType(const cv::Mat*) { return -1; }
template <typename T>
int ElementType(const cv::Mat_<T>*) {
  return cv::traits::Type<T>::value;
}

/// What a matrix of OpenCV is beside its elements.
struct MatHeader {
  std::int32_t type = 0;
  std::vector<std::int32_t> sizes;  // None: an empty matrix.
};

/// Header of a matrix.
MatHeader HeaderOf(const cv::Mat& mat);

/// A matrix of this kind; `type`: as of ElementType().
///
/// @throw InputError if there can be none, or `reader` has too little left.
cv::Mat MakeMat(const MatHeader& header, int type, const ArchiveReader& reader);

/// Writes or reads all elements of a matrix.
template <typename Archive>
void VisitElements(Archive* archive, cv::Mat* mat) {
  const std::size_t element = mat->elemSize();
  if (mat->isContinuous()) {
    archive->Raw(mat->data, mat->total() * element);
    return;
  }
  for (int v = 0; v < mat->rows; ++v) {
    archive->Raw(mat->ptr(v), mat->cols * element);
  }
}

}  // namespace internal

// What Visit() finds for the types of others.

/// A truth value.
template <typename Archive>
void Serialize(Archive* archive, bool* value) {
  std::uint8_t byte = *value ? 1 : 0;
  archive->Raw(&byte, 1);
  if constexpr (Archive::kReads) *value = byte != 0;
}

/// A text.
template <typename Archive>
void Serialize(Archive* archive, std::string* text) {
  const std::uint64_t size = archive->Count(text->size(), 1);
  if constexpr (Archive::kReads) text->resize(size);
  archive->Raw(text->data(), size);
}

/// A transform, as its matrix.
template <typename Archive, typename T, int Dim, int Mode, int Options>
void Serialize(Archive* archive,
               Eigen::Transform<T, Dim, Mode, Options>* transform) {
  (*archive)(transform->matrix());
}

/// A matrix of any size and, unless it is a cv::Mat_, type.
template <typename Archive, typename Mat>
std::enable_if_t<std::is_base_of_v<cv::Mat, Mat>> Serialize(Archive* archive,
                                                            Mat* mat) {
  internal::MatHeader header = internal::HeaderOf(*mat);
  (*archive)(header.type, header.sizes);
  cv::Mat elements = *mat;  // The same memory.
  if constexpr (Archive::kReads) {
    elements = internal::MakeMat(header, internal::ElementType(mat), *archive);
    *mat = elements;
  }
  internal::VisitElements(archive, &elements);
}

/// A pair.
template <typename Archive, typename A, typename B>
void Serialize(Archive* archive, std::pair<A, B>* pair) {
  (*archive)(pair->first, pair->second);
}

/// A value that may be missing.
template <typename Archive, typename T>
void Serialize(Archive* archive, std::optional<T>* value) {
  bool has_value = value->has_value();
  (*archive)(has_value);
  if constexpr (Archive::kReads) {
    value->reset();
    if (has_value) value->emplace();
  }
  if (has_value) (*archive)(**value);
}

/// A vector; of plain values in one piece.
template <typename Archive, typename T>
void Serialize(Archive* archive, std::vector<T>* values) {
  if constexpr (internal::IsPlain<T>::value) {
    const std::uint64_t count = archive->Count(values->size(), sizeof(T));
    if constexpr (Archive::kReads) values->resize(count);
    archive->Raw(values->data(), count * sizeof(T));
  } else {
    internal::SerializeList(archive, values);
  }
}

/// A deque.
template <typename Archive, typename T>
void Serialize(Archive* archive, std::deque<T>* values) {
  internal::SerializeList(archive, values);
}

/// An array of what is not plain.
template <typename Archive, typename T, std::size_t N>
void Serialize(Archive* archive, std::array<T, N>* values) {
  for (T& value : *values) (*archive)(value);
}

/// A set.
template <typename Archive, typename T>
void Serialize(Archive* archive, std::set<T>* values) {
  internal::SerializeTree<T>(archive, values);
}

/// A map.
template <typename Archive, typename Key, typename T>
void Serialize(Archive* archive, std::map<Key, T>* values) {
  internal::SerializeTree<std::pair<Key, T>>(archive, values);
}

/// Writes a value that the reader has already, or checks it.
///
/// @throw InputError if it is another one: "<name> = <value>: expected <own>".
template <typename Archive, typename T>
void ExpectSame(Archive* archive, const std::string& name, const T& own) {
  T value = own;
  (*archive)(value);
  if constexpr (Archive::kReads) {
    if (value == own) return;
    std::ostringstream text;
    text << std::setprecision(17) << name << " = " << value << ": expected "
         << own;
    archive->Fail(text.str());
  }
}

template <typename... T>
void ArchiveWriter::operator()(const T&... values) {
  (internal::Visit(this, const_cast<T*>(&values)), ...);
}

template <typename... T>
void ArchiveReader::operator()(T&... values) {
  (internal::Visit(this, &values), ...);
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_ARCHIVE_H_
