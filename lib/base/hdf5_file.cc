#include "splitfusion/lib/base/hdf5_file.h"

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr int kMostDimensions = 3;  // Format.
constexpr unsigned kDeflate = 4;    // Format: level of compression.
/// A byte of the file stands for no more than so many.
constexpr std::uint64_t kMostDeflated = 1100;  // Format.

/// An identifier of HDF5, closed at the end.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;

  bool valid() const { return id_ >= 0; }
  hid_t id() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// HDF5 would print its stack of errors, and at the end of the program crash
/// over a file that a full disk did not let it close. Before all other calls.
void BeQuiet() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

hid_t InMemory(Hdf5Number number) {
  switch (number) {
    case Hdf5Number::kInt32:
      return H5T_NATIVE_INT32;
    case Hdf5Number::kFloat:
      return H5T_NATIVE_FLOAT;
    default:
      return H5T_NATIVE_DOUBLE;
  }
}

hid_t InFile(Hdf5Number number) {
  switch (number) {
    case Hdf5Number::kInt32:
      return H5T_STD_I32LE;
    case Hdf5Number::kFloat:
      return H5T_IEEE_F32LE;
    default:
      return H5T_IEEE_F64LE;
  }
}

std::string NameOf(Hdf5Number number) {
  switch (number) {
    case Hdf5Number::kInt32:
      return "int32";
    case Hdf5Number::kFloat:
      return "float32";
    default:
      return "float64";
  }
}

std::string ShapeText(const std::vector<std::uint64_t>& shape) {
  std::string text;
  for (const std::uint64_t size : shape) {
    text += (text.empty() ? "" : " x ") + std::to_string(size);
  }
  return text;
}

Handle TextType(std::size_t bytes) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(1, bytes));
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

/// Compressed, with a checksum of its own, without times.
Handle DatasetProperties(const std::vector<hsize_t>& shape) {
  Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.id(), false);
  const bool empty = std::find(shape.begin(), shape.end(), 0) != shape.end();
  if (empty) return properties;
  H5Pset_chunk(properties.id(), static_cast<int>(shape.size()), shape.data());
  H5Pset_shuffle(properties.id());
  H5Pset_deflate(properties.id(), kDeflate);
  H5Pset_fletcher32(properties.id());
  return properties;
}

/// Whether all numbers are finite.
bool AreFinite(Hdf5Number number, const void* numbers, std::size_t count) {
  const auto finite = [count](const auto* values) {
    return std::all_of(values, values + count,
                       [](auto value) { return std::isfinite(value); });
  };
  if (number == Hdf5Number::kFloat)
    return finite(static_cast<const float*>(numbers));
  if (number == Hdf5Number::kDouble)
    return finite(static_cast<const double*>(numbers));
  return true;
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::string& path) : path_(path) {
  BeQuiet();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // From 1.10 on all that describes the data has checksums, too.
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.id(), false);
  file_ = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id());
  if (file_ < 0) Fail();
}

void Hdf5Writer::Fail() const {
  throw InputError(path_ +
                   ": cannot be written (folder missing, not writable or disk "
                   "full)");
}

Hdf5Writer::~Hdf5Writer() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Writer::Attribute(const std::string& name, std::string* text) {
  WriteAttribute(name, TextType(text->size()).id(), text->data());
}

void Hdf5Writer::Attribute(const std::string& name, std::int32_t* value) {
  WriteAttribute(name, H5T_STD_I32LE, value);
}

void Hdf5Writer::Attribute(const std::string& name, double* value) {
  WriteAttribute(name, H5T_IEEE_F64LE, value);
}

void Hdf5Writer::WriteAttribute(const std::string& name, std::int64_t type,
                                const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(file_, name.c_str(), type, space.id(),
                                    H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  const Handle native(H5Tget_native_type(type, H5T_DIR_ASCEND), H5Tclose);
  if (!attribute.valid() ||
      H5Awrite(attribute.id(),
               H5Tget_class(type) == H5T_STRING ? type : native.id(),
               value) < 0) {
    Fail();
  }
}

void Hdf5Writer::MakeGroup(const std::string& name) {
  if (H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0) return;
  const Handle properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.id(), false);
  const Handle group(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT,
                                properties.id(), H5P_DEFAULT),
                     H5Gclose);
  if (!group.valid()) {
    Fail();
  }
}

void Hdf5Writer::Write(const std::string& path, Hdf5Number number,
                       const std::vector<std::uint64_t>& shape,
                       const void* numbers) {
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  const Handle space(
      H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
      H5Sclose);
  const Handle properties = DatasetProperties(sizes);
  MakeGroup(path.substr(0, path.find('/')));
  const Handle dataset(
      H5Dcreate2(file_, path.c_str(), InFile(number), space.id(), H5P_DEFAULT,
                 properties.id(), H5P_DEFAULT),
      H5Dclose);
  if (!dataset.valid() || H5Dwrite(dataset.id(), InMemory(number), H5S_ALL,
                                   H5S_ALL, H5P_DEFAULT, numbers) < 0) {
    Fail();
  }
}

void Hdf5Writer::Close() {
  if (H5Fclose(std::exchange(file_, -1)) < 0) Fail();
}

Hdf5Reader::Hdf5Reader(const std::string& path) : path_(path) {
  BeQuiet();
  if (!std::filesystem::is_regular_file(path)) {
    throw InputError(path + (std::filesystem::is_directory(path)
                                 ? ": is a folder; expected an HDF5 file"
                                 : ": not found; expected an HDF5 file"));
  }
  file_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0) Fail("expected an HDF5 file");
}

Hdf5Reader::~Hdf5Reader() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Reader::Attribute(const std::string& name, std::string* text) {
  const Handle attribute(H5Aopen(file_, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Handle type(attribute.valid() ? H5Aget_type(attribute.id()) : -1,
                    H5Tclose);
  const Handle space(attribute.valid() ? H5Aget_space(attribute.id()) : -1,
                     H5Sclose);
  if (!type.valid() || H5Tget_class(type.id()) != H5T_STRING ||
      H5Tis_variable_str(type.id()) > 0 ||
      H5Sget_simple_extent_npoints(space.id()) != 1) {
    Fail("expected an attribute " + name + ", a text of fixed length");
  }
  text->assign(H5Tget_size(type.id()), '\0');
  if (H5Aread(attribute.id(), type.id(), text->data()) < 0) {
    Fail("attribute " + name + " cannot be read");
  }
  text->erase(std::find(text->begin(), text->end(), '\0'), text->end());
}

void Hdf5Reader::Attribute(const std::string& name, std::int32_t* value) {
  ReadAttribute(name, H5T_NATIVE_INT32, "a number", value);
}

void Hdf5Reader::Attribute(const std::string& name, double* value) {
  ReadAttribute(name, H5T_NATIVE_DOUBLE, "a number", value);
  if (!std::isfinite(*value)) Fail("attribute " + name + " is not finite");
}

void Hdf5Reader::ReadAttribute(const std::string& name, std::int64_t type,
                               const std::string& kind, void* value) const {
  const Handle attribute(H5Aopen(file_, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Handle space(attribute.valid() ? H5Aget_space(attribute.id()) : -1,
                     H5Sclose);
  if (!space.valid() || H5Sget_simple_extent_npoints(space.id()) != 1 ||
      H5Aread(attribute.id(), type, value) < 0) {
    Fail("expected an attribute " + name + ", " + kind);
  }
}

bool Hdf5Reader::Has(const std::string& path, bool /*here*/) const {
  return H5Lexists(file_, path.c_str(), H5P_DEFAULT) > 0;
}

bool Hdf5Reader::HasAttribute(const std::string& name) const {
  return H5Aexists(file_, name.c_str()) > 0;
}

std::uint64_t Hdf5Reader::CheckedRows(
    const std::string& path, Hdf5Number number,
    const std::vector<std::uint64_t>& item_shape) {
  const Handle dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) Fail("expected a dataset " + path);
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  std::vector<hsize_t> shape(
      std::max(1, H5Sget_simple_extent_ndims(space.id())), 0);
  if (shape.size() <= kMostDimensions) {
    H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr);
  }
  const auto expected =
      rows_.emplace(path.substr(0, path.find('/')), shape[0]).first->second;
  std::vector<std::uint64_t> wanted = item_shape;
  wanted.insert(wanted.begin(), expected);
  if (!std::equal(shape.begin(), shape.end(), wanted.begin(), wanted.end()) ||
      H5Tequal(type.id(), InFile(number)) <= 0) {
    Fail("dataset " + path + " is " + ShapeText({shape.begin(), shape.end()}) +
         ": expected " + ShapeText(wanted) + " of " + NameOf(number));
  }
  // What was never written takes no room.
  if (expected > kMostDeflated * H5Dget_storage_size(dataset.id())) {
    Fail("dataset " + path + " is damaged");
  }
  return expected;
}

void Hdf5Reader::Read(const std::string& path, Hdf5Number number,
                      std::size_t count, void* numbers) const {
  const Handle dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (H5Dread(dataset.id(), InMemory(number), H5S_ALL, H5S_ALL, H5P_DEFAULT,
              numbers) < 0) {
    Fail("dataset " + path + " is damaged");
  }
  if (!AreFinite(number, numbers, count)) {
    Fail("dataset " + path + " has a number that is not finite");
  }
}

void Hdf5Reader::Fail(const std::string& what) const {
  throw InputError(path_ + ": " + what);
}

}  // namespace splitfusion
