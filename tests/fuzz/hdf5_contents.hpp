#pragma once
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "common/archive/hdf5_file.hpp"

namespace palpate::testing {

/// Everything that is in an archive, by name, so that any of it may be changed and written with checksums that are
/// right.
struct Hdf5Contents {
  struct Dataset {
    std::variant<std::vector<double>, std::vector<float>, std::vector<std::int32_t>> values;
    std::size_t columns = 1;
  };
  std::map<std::string, std::variant<std::string, std::int64_t, double>> attributes;  ///< of the root
  std::map<std::string, Dataset> datasets;

  explicit Hdf5Contents(const std::filesystem::path& file) {
    const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    H5Aiterate2(id, H5_INDEX_NAME, H5_ITER_INC, nullptr, see_attribute, this);
    H5Ovisit2(id, H5_INDEX_NAME, H5_ITER_INC, see_object, this, H5O_INFO_BASIC);
    H5Fclose(id);
    const Hdf5Reader reader(file);
    for (auto& [name, value] : attributes) read(reader, name, value);
    for (auto& [name, dataset] : datasets)
      std::visit([&, key = name](auto& values) { read(reader, key, values); }, dataset.values);
  }

  void write(const std::filesystem::path& file) const {
    Hdf5Writer writer(file);
    for (const auto& [name, value] : attributes)
      std::visit([&, key = name](const auto& v) { writer.attribute(key, v); }, value);
    for (const auto& [name, dataset] : datasets)
      std::visit(
          [&, key = name, columns = dataset.columns](const auto& values) {
            writer.dataset({key, "1", "changed"}, values, columns);
          },
          dataset.values);
    writer.close();
  }

 private:
  static void read(const Hdf5Reader& reader, const std::string& name, std::vector<double>& values) {
    values = reader.doubles(name);
  }
  static void read(const Hdf5Reader& reader, const std::string& name, std::vector<float>& values) {
    values = reader.floats(name);
  }
  static void read(const Hdf5Reader& reader, const std::string& name, std::vector<std::int32_t>& values) {
    values = reader.integers(name);
  }
  static void read(const Hdf5Reader& reader, const std::string& name,
                   std::variant<std::string, std::int64_t, double>& value) {
    switch (value.index()) {
      case 0:
        value = reader.text(name);
        break;
      case 1:
        value = reader.integer(name);
        break;
      default:
        value = reader.number(name);
        break;
    }
  }
  static H5T_class_t class_of(hid_t type) {
    const H5T_class_t kind = H5Tget_class(type);
    H5Tclose(type);
    return kind;
  }
  static herr_t see_attribute(hid_t root, const char* name, const H5A_info_t*, void* self) {
    auto& value = static_cast<Hdf5Contents*>(self)->attributes[name];
    const hid_t attribute = H5Aopen(root, name, H5P_DEFAULT);
    const H5T_class_t kind = class_of(H5Aget_type(attribute));
    if (kind == H5T_INTEGER) value = std::int64_t{};
    if (kind == H5T_FLOAT) value = 0.0;
    H5Aclose(attribute);
    return 0;
  }
  static herr_t see_object(hid_t root, const char* name, const H5O_info_t* info, void* self) {
    if (info->type != H5O_TYPE_DATASET) return 0;
    Dataset& dataset = static_cast<Hdf5Contents*>(self)->datasets[name];
    const hid_t data = H5Dopen2(root, name, H5P_DEFAULT), space = H5Dget_space(data);
    hsize_t extent[2] = {0, 1};
    if (H5Sget_simple_extent_ndims(space) <= 2) H5Sget_simple_extent_dims(space, extent, nullptr);
    dataset.columns = extent[1];
    if (H5Tget_size(H5Dget_type(data)) == sizeof(float)) dataset.values = std::vector<float>();
    if (class_of(H5Dget_type(data)) == H5T_INTEGER) dataset.values = std::vector<std::int32_t>();
    H5Sclose(space);
    H5Dclose(data);
    return 0;
  }
};

}  // namespace palpate::testing
