#include "splitfusion/lib/export/npz_file.h"

#include <minizip/zip.h>

#include <algorithm>
#include <cassert>
#include <functional>
#include <memory>
#include <numeric>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr std::size_t kZip64From = 0xFFFFFFFF;  // Format.

/// @throw InputError unless minizip says that all is well.
void CheckZip(int status) {
  if (status == ZIP_OK) return;
  throw InputError("cannot be written: disk full?");
}

/// What an .npy file begins with: version 1.0, padded to 64 bytes.
std::string NpyHead(const std::string& type, const NpzArrays::Shape& shape) {
  constexpr std::size_t kAlignment = 64, kBefore = 10;  // Format.
  std::string sizes;
  for (const std::size_t size : shape) sizes += std::to_string(size) + ", ";
  std::string text = "{'descr': '" + type +
                     "', 'fortran_order': False, 'shape': (" + sizes + "), }";
  const std::size_t size = kBefore + text.size() + 1;
  text.append((kAlignment - size % kAlignment) % kAlignment, ' ');
  text += '\n';
  std::string head("\x93NUMPY\x01\x00", 8);      // Format.
  head += static_cast<char>(text.size() % 256);  // Format.
  head += static_cast<char>(text.size() / 256);  // Format.
  return head + text;
}

/// minizip takes 32 bits of size.
void WriteToZip(zipFile zip, const char* bytes, std::size_t size) {
  constexpr std::size_t kMost = 1u << 30;  // Speed.
  for (std::size_t begin = 0; begin < size; begin += kMost) {
    const std::size_t now = std::min(kMost, size - begin);
    CheckZip(
        zipWriteInFileInZip(zip, bytes + begin, static_cast<unsigned>(now)));
  }
}

}  // namespace

template <typename T>
void NpzArrays::AddArray(const std::string& name, const std::string& type,
                         const Shape& shape, const std::vector<T>& values) {
  assert(std::accumulate(shape.begin(), shape.end(), std::size_t{1},
                         std::multiplies<>()) == values.size());
  const std::string head = NpyHead(type, shape);
  const std::size_t size = values.size() * sizeof(T);
  zip_fileinfo info = {};  // The beginning of time, whenever it is written.
  info.tmz_date.tm_mday = 1;
  info.tmz_date.tm_year = 1980;  // Format.
  CheckZip(zipOpenNewFileInZip64(zip_, (name + ".npy").c_str(), &info, nullptr,
                                 0, nullptr, 0, nullptr, /*method=*/0,
                                 /*level=*/0, size + head.size() > kZip64From));
  WriteToZip(zip_, head.data(), head.size());
  WriteToZip(zip_, reinterpret_cast<const char*>(values.data()), size);
  CheckZip(zipCloseFileInZip(zip_));
}

void NpzArrays::Add(const std::string& name, const Shape& shape,
                    const std::vector<float>& values) {
  AddArray(name, "<f4", shape, values);
}

void NpzArrays::Add(const std::string& name, const Shape& shape,
                    const std::vector<double>& values) {
  AddArray(name, "<f8", shape, values);
}

void NpzArrays::Add(const std::string& name, const Shape& shape,
                    const std::vector<std::int32_t>& values) {
  AddArray(name, "<i4", shape, values);
}

void NpzArrays::Add(const std::string& name, const Shape& shape,
                    const std::vector<std::uint8_t>& values) {
  AddArray(name, "|u1", shape, values);
}

void WriteNpz(const std::string& path,
              const std::function<void(NpzArrays*)>& fill) {
  WritePathAtomically(path, [&](const std::string& temporary) {
    try {
      zipFile zip = zipOpen64(temporary.c_str(), APPEND_STATUS_CREATE);
      if (zip == nullptr) {
        throw InputError("cannot be written (folder missing or not writable)");
      }
      const auto close = [](void* open) { zipClose(open, nullptr); };
      std::unique_ptr<void, decltype(close)> guard(zip, close);
      NpzArrays arrays(zip);
      fill(&arrays);
      CheckZip(zipClose(guard.release(), nullptr));
    } catch (const InputError& error) {
      throw InputError(path + ": " + error.what());
    }
  });
}

}  // namespace splitfusion
