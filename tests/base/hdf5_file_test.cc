#include "splitfusion/lib/base/hdf5_file.h"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

struct Item {
  std::int32_t number = 0;
  std::array<float, 2> pair{};
  Eigen::Matrix<double, 2, 3> matrix = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Vector3f vector = Eigen::Vector3f::Zero();

  bool operator==(const Item& o) const {
    return number == o.number && pair == o.pair && matrix == o.matrix &&
           vector == o.vector;
  }
};

template <typename File>
void Visit(File* file, std::vector<Item>* items) {
  file->Column(
      "items/number", items, [](Item & i) -> auto& { return i.number; });
  file->Column(
      "items/pair", items, [](Item & i) -> auto& { return i.pair; });
  file->Column(
      "items/matrix", items, [](Item & i) -> auto& { return i.matrix; });
  file->Column(
      "items/vector", items, [](Item & i) -> auto& { return i.vector; });
}

/// Numbers that do not compress to nothing.
std::vector<Item> SampleItems(int count) {
  std::vector<Item> items(count);
  for (int k = 0; k < count; ++k) {
    items[k].number = k * k - 7;
    items[k].pair = {std::sin(k + 0.5f), -0.1f};
    items[k].matrix << k, 1.0 / 3, -2e-300, std::cos(k), 5, 1e300;
    items[k].vector = {float(k), std::exp(-0.1f * k), -1};
  }
  return items;
}

void WriteItems(const std::string& path, std::vector<Item> items) {
  Hdf5Writer file(path);
  Visit(&file, &items);
  file.Close();
}

std::vector<Item> ReadItems(const std::string& path) {
  Hdf5Reader file(path);
  std::vector<Item> items;
  Visit(&file, &items);
  return items;
}

std::string Bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Hdf5File, GivesBackEveryBit) {
  const TemporaryFolder folder;
  for (const int count : {0, 1, 1000}) {
    const std::vector<Item> items = SampleItems(count);
    WriteItems(folder / "a.h5", items);
    EXPECT_EQ(ReadItems(folder / "a.h5"), items) << count;
  }
}

TEST(Hdf5File, TheSameContentHasTheSameBytes) {
  const TemporaryFolder folder;
  WriteItems(folder / "a.h5", SampleItems(100));
  WriteItems(folder / "b.h5", SampleItems(100));
  EXPECT_EQ(Bytes(folder / "a.h5"), Bytes(folder / "b.h5"));
}

TEST(Hdf5File, KeepsAttributes) {
  const TemporaryFolder folder;
  {
    Hdf5Writer file(folder / "a.h5");
    std::string text = "arap(weight=8)", empty;
    std::int32_t count = -3;
    double value = 0.1;
    file.Attribute("text", &text);
    file.Attribute("empty", &empty);
    file.Attribute("count", &count);
    file.Attribute("value", &value);
    file.Close();
  }
  Hdf5Reader file(folder / "a.h5");
  std::string text, empty = "not";
  std::int32_t count = 0;
  double value = 0;
  file.Attribute("text", &text);
  file.Attribute("empty", &empty);
  file.Attribute("count", &count);
  file.Attribute("value", &value);
  EXPECT_EQ(text, "arap(weight=8)");
  EXPECT_EQ(empty, "");
  EXPECT_EQ(count, -3);
  EXPECT_EQ(value, 0.1);
  ExpectInputError([&] { file.Attribute("none", &text); },
                   "expected an attribute none");
  ExpectInputError([&] { file.Attribute("count", &text); },
                   "expected an attribute count, a text");
  ExpectInputError([&] { file.Attribute("text", &value); },
                   "expected an attribute text, a number");
}

TEST(Hdf5File, SaysWhatIsNotAsExpected) {
  const TemporaryFolder folder;
  WriteItems(folder / "a.h5", SampleItems(3));
  Hdf5Reader file(folder / "a.h5");
  EXPECT_TRUE(file.Has("items/pair", false));
  EXPECT_FALSE(file.Has("others", true));
  std::vector<float> floats;
  ExpectInputError([&] { file.Column("items/none", &floats); },
                   "a.h5: expected a dataset items/none");
  ExpectInputError([&] { file.Column("items/number", &floats); },
                   "dataset items/number is 3: expected 3 of float32");
  ExpectInputError([&] { file.Column("items/pair", &floats); },
                   "dataset items/pair is 3 x 2: expected 3 of float32");
  ExpectInputError([&] { Hdf5Reader(folder / "none.h5"); }, "not found");
  ExpectInputError([&] { Hdf5Reader(folder.Write("b.h5", "text")); },
                   "b.h5: expected an HDF5 file");
}

TEST(Hdf5File, GroupsHaveEquallyManyRows) {
  const TemporaryFolder folder;
  {
    Hdf5Writer file(folder / "a.h5");
    std::vector<double> two = {1, 2}, three = {1, 2, 3};
    file.Column("group/a", &two);
    file.Column("group/b", &three);
    file.Close();
  }
  Hdf5Reader file(folder / "a.h5");
  std::vector<double> values;
  file.Column("group/a", &values);
  ExpectInputError([&] { file.Column("group/b", &values); },
                   "dataset group/b is 3: expected 2 of float64");
}

TEST(Hdf5File, RefusesWhatIsNotFinite) {
  const TemporaryFolder folder;
  {
    Hdf5Writer file(folder / "a.h5");
    std::vector<float> values = {1, std::numeric_limits<float>::quiet_NaN()};
    file.Column("group/a", &values);
    file.Close();
  }
  Hdf5Reader file(folder / "a.h5");
  std::vector<float> values;
  ExpectInputError([&] { file.Column("group/a", &values); },
                   "dataset group/a has a number that is not finite");
}

TEST(Hdf5File, AFileThatCannotBeWrittenIsOneLine) {
  const TemporaryFolder folder;
  ExpectInputError([&] { Hdf5Writer(folder / "no/such/c.h5"); },
                   "c.h5: cannot be written");
}

TEST(Hdf5File, TextsOfOthersAreRead) {
  // An array of texts is none; of one that another program padded all counts.
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const hid_t file =
      H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, 5);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  const hsize_t many = 3000;
  for (const bool array : {false, true}) {
    const hid_t space =
        array ? H5Screate_simple(1, &many, nullptr) : H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(file, array ? "array" : "text", type,
                                       space, H5P_DEFAULT, H5P_DEFAULT);
    const std::string text(5 * many, 'x');
    H5Awrite(attribute, type, text.data());
    H5Aclose(attribute);
    H5Sclose(space);
  }
  H5Tclose(type);
  H5Fclose(file);
  Hdf5Reader reader(path);
  std::string text;
  reader.Attribute("text", &text);
  EXPECT_EQ(text, "xxxxx");
  ExpectInputError([&] { reader.Attribute("array", &text); },
                   "expected an attribute array, a text");
}

TEST(Hdf5File, NoDamageGoesUnnoticed) {
  // Whatever bit of the file is wrong: an error, or what was written.
  const TemporaryFolder folder;
  const std::vector<Item> items = SampleItems(60);
  WriteItems(folder / "a.h5", items);
  const std::string bytes = Bytes(folder / "a.h5");
  int noticed = 0, tried = 0;
  for (std::size_t at = 0; at < bytes.size(); at += 7, ++tried) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (at % 8)));
    folder.Write("b.h5", damaged);
    try {
      EXPECT_TRUE(ReadItems(folder / "b.h5") == items) << "byte " << at;
    } catch (const InputError&) {
      ++noticed;
    }
  }
  EXPECT_GT(noticed, tried / 2);
  for (const double share : {0.1, 0.5, 0.99}) {
    folder.Write("b.h5", bytes.substr(0, std::size_t(share * bytes.size())));
    EXPECT_THROW(ReadItems(folder / "b.h5"), InputError) << share;
  }
}

}  // namespace
}  // namespace splitfusion
