#include "tools/organ/label_volume.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/files/ending.hpp"
#include "tools/organ/image_checks.hpp"

namespace palpate {
namespace {

using Header = std::map<std::string, std::string>;
using GzFile = std::unique_ptr<gzFile_s, int (*)(gzFile)>;

/// The lines KEY=VALUE of the header, which fills whole blocks of 256 bytes and ends in "##}".
Header read_header(gzFile in) {
  constexpr std::size_t kBlock = 256, kMaxBlocks = 64;
  std::string text;
  while (text.find("##}") == std::string::npos) {
    if (text.size() >= kBlock * kMaxBlocks) throw std::runtime_error("its header has no end, ##}");
    char block[kBlock];
    if (gzread(in, block, kBlock) != static_cast<int>(kBlock)) throw std::runtime_error("it ends within its header");
    text.append(block, kBlock);
    if (!text.starts_with("#INRIMAGE-4#{"))
      throw std::runtime_error("it does not begin as an INR image, #INRIMAGE-4#{");
  }
  Header header;
  for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string line = text.substr(at, end - at);
    if (const std::size_t equals = line.find('='); equals != std::string::npos)
      header[line.substr(0, equals)] = line.substr(equals + 1);
  }
  return header;
}

double number(const Header& header, const std::string& key, double otherwise) {
  const auto found = header.find(key);
  if (found == header.end()) return otherwise;
  double value = 0;
  const char* const end = found->second.data() + found->second.size();
  const auto [stop, error] = std::from_chars(found->second.data(), end, value);
  if (error != std::errc() || !std::isfinite(value))
    throw std::runtime_error(fmt::format("its {} is '{}', which is no number", key, found->second.substr(0, 20)));
  return value;
}

GridShape shape_of(const Header& header) {
  GridShape shape{{}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()};
  double voxels = 1;
  for (int a = 0; a < 3; ++a) {
    const std::string axis(1, "XYZ"[a]);
    const double count = number(header, axis + "DIM", 0);
    shape.spacing[a] = 1e-3 * number(header, "V" + axis, 1);
    voxels *= count;
    if (!(count >= 1 && count <= 65536 && count == std::floor(count) && voxels <= kMaxVoxels))
      throw std::runtime_error(
          fmt::format("its {}DIM is {}: 1 to 65536 voxels along an axis are read, a billion in all", axis, count));
    if (!(shape.spacing[a] > 0)) throw std::runtime_error(fmt::format("its voxel size V{} is not positive", axis));
    shape.count[a] = static_cast<int>(count);
  }
  if (number(header, "VDIM", 1) != 1) throw std::runtime_error("it has several values at a voxel");
  return shape;
}

/// Whether not every stored value is one that is asked for as it is: of fractions and numbers above 2^31 labels are
/// not.
template <class Stored, class T>
constexpr bool kMayBeNone = std::is_integral_v<T> &&
                            (std::is_floating_point_v<Stored> || std::is_same_v<Stored, std::uint32_t>);

template <class Stored, class T>
void take_values(gzFile in, bool swapped, Volume<T>& volume) {
  std::vector<Stored> row(volume.shape.count[0]);
  const auto bytes = static_cast<unsigned>(row.size() * sizeof(Stored));
  LabelTaker labels(volume.shape);
  while (volume.value.size() < volume.shape.size()) {
    if (gzread(in, row.data(), bytes) != static_cast<int>(bytes))
      throw std::runtime_error("it ends before its last voxel");
    for (Stored value : row) {
      if (swapped) {
        auto* const raw = reinterpret_cast<unsigned char*>(&value);
        std::reverse(raw, raw + sizeof value);
      }
      if constexpr (kMayBeNone<Stored, T>)
        volume.value.push_back(labels.take(value, volume.value.size()));
      else
        volume.value.push_back(static_cast<T>(value));
    }
  }
  volume.is_high = labels.is_high();
}

std::string value_of(const Header& header, const std::string& key) {
  const auto found = header.find(key);
  return found == header.end() ? "" : found->second;
}

template <class T>
void take_whole_numbers(gzFile in, double bits, bool negative_too, bool swapped, Volume<T>& volume) {
  if (bits == 8)
    negative_too ? take_values<std::int8_t>(in, swapped, volume) : take_values<std::uint8_t>(in, swapped, volume);
  else if (bits == 16)
    negative_too ? take_values<std::int16_t>(in, swapped, volume) : take_values<std::uint16_t>(in, swapped, volume);
  else if (bits == 32)
    negative_too ? take_values<std::int32_t>(in, swapped, volume) : take_values<std::uint32_t>(in, swapped, volume);
  else
    throw std::runtime_error(fmt::format("its values have {} bits: 8, 16 and 32 are read", bits));
}

template <class T>
void take_fractions(gzFile in, double bits, bool swapped, Volume<T>& volume) {
  if (bits == 32)
    take_values<float>(in, swapped, volume);
  else if (bits == 64)
    take_values<double>(in, swapped, volume);
  else
    throw std::runtime_error(fmt::format("its fractions have {} bits: 32 and 64 are read", bits));
}

template <class T>
Volume<T> read_volume(const std::filesystem::path& file, const std::string& series) try {
  if (!std::filesystem::exists(file)) throw std::runtime_error("it does not exist");
  if (!series.empty() && !std::filesystem::is_directory(file))
    throw std::runtime_error("--series is of a folder of DICOM files");
  if (has_ending(file, ".inr") || has_ending(file, ".inr.gz")) return read_inr<T>(file);
  for (const char* ending : {".nii", ".nii.gz", ".mhd", ".mha", ".nrrd", ".nhdr"})
    if (has_ending(file, ending)) return read_with_image_library<T>(file, series);
  if (std::filesystem::is_directory(file)) return read_with_image_library<T>(file, series);
  throw std::runtime_error(
      "an image is read from .inr, .inr.gz, .nii, .nii.gz, .mhd, .mha, .nrrd, .nhdr and a folder of DICOM files");
} catch (const std::runtime_error& error) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), error.what()));
}

}  // namespace

template <class T>
Volume<T> read_inr(const std::filesystem::path& file) {
  const GzFile in(gzopen(file.c_str(), "rb"), gzclose);
  if (!in) throw std::runtime_error("it cannot be opened");
  const Header header = read_header(in.get());
  Volume<T> volume{shape_of(header), {}};
  const std::string type = value_of(header, "TYPE"), cpu = value_of(header, "CPU");
  const bool swapped = cpu == "sun" || cpu == "sgi";
  const double bits = number(header, "PIXSIZE", std::strtod(value_of(header, "PIXSIZE").c_str(), nullptr));
  if (type.ends_with("fixed"))
    take_whole_numbers(in.get(), bits, type.starts_with("signed"), swapped, volume);
  else if (type == "float")
    take_fractions(in.get(), bits, swapped, volume);
  else
    throw std::runtime_error(
        fmt::format("its TYPE is '{}': unsigned fixed, signed fixed and float are read", type.substr(0, 30)));
  if constexpr (std::is_same_v<T, float>) check_finite(volume.shape, volume.value);
  return volume;
}

template LabelVolume read_inr(const std::filesystem::path&);
template GreyVolume read_inr(const std::filesystem::path&);

std::string say_size(const GridShape& image) {
  const Eigen::Vector3d mm = 1e3 * image.spacing;
  return fmt::format("{} x {} x {} voxels of {:.4g} x {:.4g} x {:.4g} mm", image.count[0], image.count[1],
                     image.count[2], mm.x(), mm.y(), mm.z());
}

LabelVolume read_label_volume(const std::filesystem::path& file, const std::string& series) {
  return read_volume<std::int32_t>(file, series);
}

GreyVolume read_grey_volume(const std::filesystem::path& file, const std::string& series) {
  return read_volume<float>(file, series);
}

}  // namespace palpate
