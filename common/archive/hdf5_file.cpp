#include "common/archive/hdf5_file.hpp"

#include <hdf5.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/describe/digest.hpp"

namespace palpate {
namespace {

constexpr const char* kChecksum = "xxh3_128";
constexpr std::size_t kLongestText = 64 * 1024;  // of an attribute

/// An HDF5 identifier and the function that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Errors become exceptions here: HDF5 prints none, and a file that failed to close is not tried again at
/// exit.
void quieten() {
  static const bool once = [] {
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return true;
  }();
  static_cast<void>(once);
}

bool error_stack_has(hid_t minor) {
  struct Search {
    hid_t minor;
    bool found;
  } search{minor, false};
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
        auto* wanted = static_cast<Search*>(data);
        wanted->found |= error->min_num == wanted->minor;
        return 0;
      },
      &search);
  return search.found;
}

/// The operating system's words for the last failure, dug out of HDF5's error stack.
std::string system_reason() {
  std::string reason;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
        const std::string text = error->desc ? error->desc : "", key = "error message = '";
        const auto begin = text.find(key);
        if (begin == std::string::npos) return 0;
        const auto start = begin + key.size();
        *static_cast<std::string*>(data) = text.substr(start, text.find('\'', start) - start);
        return 0;
      },
      &reason);
  return reason.empty() ? "the disk may be full" : reason;
}

template <class T>
hid_t native_type();
template <>
hid_t native_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t native_type<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
hid_t native_type<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
template <>
hid_t native_type<std::int64_t>() {
  return H5T_NATIVE_INT64;
}

template <class T>
bool write_scalar(hid_t object, const std::string& name, T value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name.c_str(), native_type<T>(), space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute >= 0 && H5Awrite(attribute, native_type<T>(), &value) >= 0;
}

/// Fixed-length strings live inside the checksummed object header.
bool write_text(hid_t object, const std::string& name, const std::string& value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, value.size() + 1);
  H5Tset_cset(type, H5T_CSET_UTF8);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute >= 0 && H5Awrite(attribute, type, value.c_str()) >= 0;
}

bool read_text(hid_t object, const std::string& name, std::string& value) {
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (attribute < 0) return false;
  const Handle type(H5Aget_type(attribute), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) return false;
  if (H5Tget_size(type) > kLongestText) return false;
  value.assign(H5Tget_size(type), '\0');
  if (H5Aread(attribute, type, value.data()) < 0) return false;
  value.resize(value.find('\0') == std::string::npos ? value.size() : value.find('\0'));
  return true;
}

template <class T>
bool read_scalar(hid_t object, const std::string& name, T& value) {
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (attribute < 0) return false;
  const Handle space(H5Aget_space(attribute), H5Sclose);
  return H5Sget_simple_extent_npoints(space) == 1 && H5Aread(attribute, native_type<T>(), &value) >= 0;
}

/// Without the time at which it is made: one that HDF5 makes on the way to a dataset would keep it.
void ensure_group(hid_t file, const std::string& name) {
  if (H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0) return;
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, 0);
  const Handle group(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose);
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::filesystem::path& file) : file_(file) {
  quieten();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, 0);  // the same content makes the same bytes, whenever it is written
  // From version 1.8 on HDF5 checksums its metadata.
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  id_ = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation, access);
  if (id_ < 0) fail();
}

Hdf5Writer::~Hdf5Writer() {
  if (id_ >= 0) H5Fclose(id_);
}

void Hdf5Writer::fail() const {
  throw std::runtime_error(file_.string() + ": cannot be written: " + system_reason());
}

void Hdf5Writer::attribute(const std::string& name, const std::string& value) {
  if (!write_text(id_, name, value)) fail();
}

void Hdf5Writer::attribute(const std::string& name, std::int64_t value) {
  if (!write_scalar(id_, name, value)) fail();
}

void Hdf5Writer::attribute(const std::string& name, double value) {
  if (!write_scalar(id_, name, value)) fail();
}

void Hdf5Writer::dataset(const DatasetLabel& label, const std::vector<double>& values, std::size_t columns) {
  write(label, values, columns);
}

void Hdf5Writer::dataset(const DatasetLabel& label, const std::vector<float>& values, std::size_t columns) {
  write(label, values, columns);
}

void Hdf5Writer::dataset(const DatasetLabel& label, const std::vector<std::int32_t>& values, std::size_t columns) {
  write(label, values, columns);
}

template <class T>
void Hdf5Writer::write(const DatasetLabel& label, const std::vector<T>& values, std::size_t columns) {
  if (values.empty()) return;
  if (const auto end = label.name.find('/'); end != label.name.npos) ensure_group(id_, label.name.substr(0, end));
  const hsize_t extent[2] = {values.size() / columns, columns};
  const Handle space(H5Screate_simple(columns == 1 ? 1 : 2, extent, nullptr), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
  H5Pset_obj_track_times(creation, 0);
  const Handle data(H5Dcreate2(id_, label.name.c_str(), native_type<T>(), space, H5P_DEFAULT, creation, H5P_DEFAULT),
                    H5Dclose);
  const bool done = data >= 0 && write_text(data, "units", label.units) &&
                    write_text(data, "description", label.description) &&
                    write_text(data, kChecksum, digest(values.data(), values.size() * sizeof(T))) &&
                    H5Dwrite(data, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  if (!done) fail();
}

void Hdf5Writer::close() {
  if (H5Fclose(std::exchange(id_, -1)) < 0) fail();
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file) : file_(file) {
  quieten();
  if (!std::filesystem::exists(file)) fail("no such file");
  if (H5Fis_hdf5(file.c_str()) <= 0) fail("not a palpate archive");
  id_ = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id_ < 0) fail(error_stack_has(H5E_TRUNCATED) ? "truncated" : "damaged: " + system_reason());
}

Hdf5Reader::~Hdf5Reader() {
  if (id_ >= 0) H5Fclose(id_);
}

void Hdf5Reader::fail(const std::string& reason) const {
  throw std::runtime_error(file_.string() + ": " + reason);
}

bool Hdf5Reader::has_attribute(const std::string& name) const {
  return H5Aexists(id_, name.c_str()) > 0;
}

std::string Hdf5Reader::text(const std::string& name) const {
  std::string value;
  if (!read_text(id_, name, value)) fail("damaged: attribute '" + name + "' cannot be read");
  return value;
}

std::int64_t Hdf5Reader::integer(const std::string& name) const {
  std::int64_t value = 0;
  if (!read_scalar(id_, name, value)) fail("damaged: attribute '" + name + "' cannot be read");
  return value;
}

double Hdf5Reader::number(const std::string& name) const {
  double value = 0;
  if (!read_scalar(id_, name, value)) fail("damaged: attribute '" + name + "' cannot be read");
  if (!kAnyNumber.contains(value)) fail("damaged: attribute '" + name + "' is no number");
  return value;
}

int Hdf5Reader::count(const std::string& name) const {
  const std::int64_t value = integer(name);
  if (value < 0 || value > std::numeric_limits<int>::max()) fail("damaged: attribute '" + name + "' is no count");
  return static_cast<int>(value);
}

std::vector<double> Hdf5Reader::doubles(const std::string& name, const Range& each) const {
  auto values = read<double>(name);
  if (!std::ranges::all_of(values, [&](double x) { return each.contains(x); }))
    fail("damaged: '" + name + "' has a number that cannot be");
  return values;
}

std::vector<float> Hdf5Reader::floats(const std::string& name) const {
  auto values = read<float>(name);
  if (!std::ranges::all_of(values, [](float x) { return kAnyNumber.contains(x); }))
    fail("damaged: '" + name + "' has a number that cannot be");
  return values;
}

template <class T>
std::vector<T> Hdf5Reader::read(const std::string& name) const {
  // H5Lexists wants every group on the way to exist.
  for (auto slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    const htri_t group = H5Lexists(id_, name.substr(0, slash).c_str(), H5P_DEFAULT);
    if (group == 0) return {};
    if (group < 0) fail("damaged: '" + name + "' cannot be read");
  }
  const htri_t exists = H5Lexists(id_, name.c_str(), H5P_DEFAULT);
  if (exists == 0) return {};
  const Handle data(exists > 0 ? H5Dopen2(id_, name.c_str(), H5P_DEFAULT) : -1, H5Dclose);
  if (data < 0) fail("damaged: '" + name + "' cannot be read");
  const Handle space(H5Dget_space(data), H5Sclose);
  const auto count = H5Sget_simple_extent_npoints(space);
  // Nothing is taken on the word of a file that is shorter than that.
  if (count > 0 && static_cast<std::uintmax_t>(count) > std::filesystem::file_size(file_) / sizeof(T))
    fail("damaged: '" + name + "' is longer than the file");
  std::vector<T> values(count > 0 ? static_cast<std::size_t>(count) : 0);
  std::string expected;
  if (H5Dread(data, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail("damaged: '" + name + "' cannot be read");
  if (!read_text(data, kChecksum, expected) || expected != digest(values.data(), values.size() * sizeof(T)))
    fail("damaged: '" + name + "' fails its checksum");
  return values;
}

template std::vector<double> Hdf5Reader::read(const std::string&) const;
template std::vector<float> Hdf5Reader::read(const std::string&) const;
template std::vector<std::int32_t> Hdf5Reader::read(const std::string&) const;

}  // namespace palpate
