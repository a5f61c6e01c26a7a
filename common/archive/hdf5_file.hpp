#pragma once
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "common/describe/range.hpp"

namespace palpate {

/// Of numbers that are read: any, and those above zero. Neither holds an infinity.
inline constexpr Range kAnyNumber =
    strictly_within(-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
inline constexpr Range kAboveZero = strictly_within(0, std::numeric_limits<double>::infinity());

/// What a dataset says about itself.
struct DatasetLabel {
  std::string name;  ///< path below the root
  std::string units;
  std::string description;
};

/// Writes one HDF5 file whose metadata carry checksums; each dataset carries the XXH3-128 of its payload.
/// Throws std::runtime_error("FILE: cannot be written: reason").
class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& file);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  void attribute(const std::string& name, const std::string& value);
  void attribute(const std::string& name, std::int64_t value);
  void attribute(const std::string& name, double value);
  /// `values` holds rows x columns entries, row by row; one column makes a vector. Nothing is written when
  /// empty.
  void dataset(const DatasetLabel& label, const std::vector<double>& values, std::size_t columns = 1);
  void dataset(const DatasetLabel& label, const std::vector<float>& values, std::size_t columns = 1);
  void dataset(const DatasetLabel& label, const std::vector<std::int32_t>& values, std::size_t columns = 1);
  void close();

 private:
  template <class T>
  void write(const DatasetLabel& label, const std::vector<T>& values, std::size_t columns);
  [[noreturn]] void fail() const;

  std::filesystem::path file_;
  std::int64_t id_ = -1;
};

/// Reads such a file. Throws std::runtime_error("FILE: reason") in plain words.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& file);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  bool has_attribute(const std::string& name) const;
  std::string text(const std::string& name) const;
  bool flag(const std::string& name) const { return integer(name) != 0; }
  /// From 0 to the largest `int`.
  int count(const std::string& name) const;
  double number(const std::string& name) const;
  std::int64_t integer(const std::string& name) const;
  /// Empty if there is no such dataset. The payload is checked against its checksum, and each number against its range.
  std::vector<double> doubles(const std::string& name, const Range& each = kAnyNumber) const;
  /// Likewise; each finite.
  std::vector<float> floats(const std::string& name) const;
  std::vector<std::int32_t> integers(const std::string& name) const { return read<std::int32_t>(name); }
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  template <class T>
  std::vector<T> read(const std::string& name) const;

  std::filesystem::path file_;
  std::int64_t id_ = -1;
};

}  // namespace palpate
