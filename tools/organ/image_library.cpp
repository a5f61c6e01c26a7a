#include <fmt/format.h>
#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkImageFileReader.h>
#include <itkImageSeriesReader.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include <Eigen/Geometry>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <stdexcept>

#include "common/files/ending.hpp"
#include "common/mesh/child.hpp"
#include "tools/organ/dicom_file.hpp"
#include "tools/organ/image_checks.hpp"
#include "tools/organ/label_volume.hpp"
#include "tools/organ/meta_image_file.hpp"
#include "tools/organ/nifti_file.hpp"

namespace palpate {
namespace {

template <class T>
using Image = itk::Image<T, 3>;

constexpr std::int64_t kMaxDeflated = 1032;  // times a file's size: no more bytes come of it

/// Whether an NRRD file is too short for so many bytes of voxels; false where these are in another. ITK makes room for
/// all that is announced.
bool is_cut_short(const std::string& file, std::int64_t bytes) {
  constexpr std::size_t kHeader = 4096;
  std::string head(kHeader, '\0');
  std::ifstream(file, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  const auto has = [&](const char* words) { return head.find(words) != std::string::npos; };
  if (has("data file:") || has("datafile:")) return false;
  return kMaxDeflated * static_cast<std::int64_t>(std::filesystem::file_size(file)) < bytes;
}

/// Of a file whose header ITK has read.
bool is_whole(const std::string& file, const itk::ImageIOBase& format, std::int64_t voxels) {
  const auto bytes = voxels * static_cast<std::int64_t>(format.GetComponentSize() * format.GetNumberOfComponents());
  if (has_ending(file, ".mha") || has_ending(file, ".mhd")) return holds_all_voxels(file, bytes);
  const bool is_nrrd = has_ending(file, ".nrrd") || has_ending(file, ".nhdr");
  return !is_nrrd || !is_cut_short(file, bytes);
}

/// Whether ITK makes labels of such values without cutting anything off.
bool hold_labels(itk::IOComponentEnum type) {
  using Type = itk::IOComponentEnum;
  return type == Type::UCHAR || type == Type::CHAR || type == Type::USHORT || type == Type::SHORT || type == Type::INT;
}

/// Values of an image, and Volume::is_high of them.
template <class T>
struct ReadImage {
  typename Image<T>::Pointer image;
  bool is_high = false;
};

ReadImage<std::int32_t> labels_of(const Image<double>& stored) {
  const auto region = stored.GetLargestPossibleRegion();
  const auto labels = Image<std::int32_t>::New();
  labels->CopyInformation(&stored);
  labels->SetRegions(region);
  labels->Allocate();
  GridShape shape;
  for (int a = 0; a < 3; ++a) shape.count[a] = static_cast<int>(region.GetSize()[a]);
  LabelTaker taker(shape);
  for (std::size_t i = 0; i < region.GetNumberOfPixels(); ++i)
    labels->GetBufferPointer()[i] = taker.take(stored.GetBufferPointer()[i], i);
  return {labels, taker.is_high()};
}

/// Calls read<what the values are asked for as>(), so that labels which are stored as fractions are looked at first.
template <class T, class Read>
ReadImage<T> read_exactly(itk::IOComponentEnum stored, const Read& read) {
  if constexpr (std::is_integral_v<T>)
    if (!hold_labels(stored)) return labels_of(*read.template operator()<double>());
  return {read.template operator()<T>()};
}

template <class T, class FileFormat>
ReadImage<T> read_image(const std::string& file) {
  const auto format = FileFormat::New();
  format->SetFileName(file);
  format->ReadImageInformation();
  std::int64_t voxels = 1;
  for (unsigned a = 0; a < format->GetNumberOfDimensions(); ++a) {
    const auto count = static_cast<std::int64_t>(format->GetDimensions(a));
    if (count < 1 || count > 65536 || (voxels *= count) > kMaxVoxels)
      throw std::runtime_error("it announces more voxels than the billion that is read");
  }
  if (!is_whole(file, *format, voxels)) throw std::runtime_error("it ends before its last voxel");
  return read_exactly<T>(format->GetComponentType(), [&]<class Value>() -> typename Image<Value>::Pointer {
    const auto reader = itk::ImageFileReader<Image<Value>>::New();
    reader->SetImageIO(format);
    reader->SetFileName(file);
    reader->Update();
    return reader->GetOutput();
  });
}

std::vector<std::string> files_of_series(const std::string& folder, const std::string& wanted) {
  const auto names = itk::GDCMSeriesFileNames::New();
  names->SetDirectory(folder);
  const auto& series = names->GetSeriesUIDs();
  if (series.empty()) throw std::runtime_error("no DICOM series lies in this folder");
  if (wanted.empty() && series.size() == 1) return names->GetFileNames(series.front());
  std::string known;
  for (const std::string& uid : series) {
    const auto files = names->GetFileNames(uid);
    if (uid == wanted) return files;
    known += fmt::format("{}{} of {} pictures", known.empty() ? "" : ", ", uid, files.size());
  }
  throw std::runtime_error(
      wanted.empty() ? fmt::format("{} DICOM series lie in this folder, choose by --series: {}", series.size(), known)
                     : fmt::format("no series '{}' lies in this folder, but {}", wanted, known));
}

/// Numbers of an element of a slice's header; none where it is not there, or not so many.
std::vector<double> numbers_of(const itk::GDCMImageIO& slice, const char* element, std::size_t count) {
  std::string text;
  itk::ExposeMetaData<std::string>(slice.GetMetaDataDictionary(), element, text);
  std::vector<double> numbers;
  const char* at = text.c_str();
  for (char* end = nullptr; numbers.size() < count; at = *end == '\\' ? end + 1 : end) {
    numbers.push_back(std::strtod(at, &end));
    if (end == at || !std::isfinite(numbers.back())) return {};
  }
  return numbers;
}

[[noreturn]] void refuse_slice(const std::string& file, const std::string& why) {
  throw std::runtime_error(fmt::format("its slice {} {}", std::filesystem::path(file).filename().string(), why));
}

/// A slice's header, which says of itself what a volume needs.
itk::GDCMImageIO::Pointer header_of_slice(const std::string& file) {
  if (!dicom_is_whole(file)) refuse_slice(file, "ends before its last pixel");
  const auto slice = itk::GDCMImageIO::New();
  slice->SetFileName(file);
  slice->ReadImageInformation();
  if (numbers_of(*slice, "0020|0032", 3).empty())
    refuse_slice(file, "does not say where it lies (Image Position), and the spacing is not known without");
  if (numbers_of(*slice, "0028|0030", 2).empty())
    refuse_slice(file, "does not say how large its pixels are (Pixel Spacing)");
  if (numbers_of(*slice, "0020|0037", 6).empty())
    refuse_slice(file, "does not say how its rows and columns lie (Image Orientation)");
  return slice;
}

/// Whether two slices have the same columns, rows, pixels and axes.
void check_alike(const itk::GDCMImageIO& first, const itk::GDCMImageIO& other, const std::string& file) {
  constexpr double kSame = 1e-3;  // of a pixel's size, and in axes, which are written with few digits
  for (unsigned a = 0; a < 2; ++a) {
    if (other.GetDimensions(a) != first.GetDimensions(a))
      refuse_slice(file, fmt::format("has {} x {} pixels, and the first one {} x {}", other.GetDimensions(0),
                                     other.GetDimensions(1), first.GetDimensions(0), first.GetDimensions(1)));
    if (!(std::abs(other.GetSpacing(a) - first.GetSpacing(a)) < kSame * first.GetSpacing(a)))
      refuse_slice(file,
                   fmt::format("has pixels of {:.4g} x {:.4g} mm, and the first one {:.4g} x {:.4g} mm",
                               other.GetSpacing(0), other.GetSpacing(1), first.GetSpacing(0), first.GetSpacing(1)));
    for (unsigned r = 0; r < 3; ++r)
      if (!(std::abs(other.GetDirection(a)[r] - first.GetDirection(a)[r]) < kSame))
        refuse_slice(file, "lies otherwise than the first one (Image Orientation)");
  }
}

/// What the headers of all slices say is looked at before their pixels are read.
void check_slices(const std::vector<std::string>& files) {
  if (files.size() == 1) {  // of one picture, or of many, which have their places elsewhere
    if (!dicom_is_whole(files.front())) refuse_slice(files.front(), "ends before its last pixel");
    return;
  }
  const auto first = header_of_slice(files.front());
  SlicePlaces slices{{}, {}, std::min(first->GetSpacing(0), first->GetSpacing(1))};
  const std::vector<double> row = first->GetDirection(0), column = first->GetDirection(1);
  slices.normal = Eigen::Vector3d(row[0], row[1], row[2]).cross(Eigen::Vector3d(column[0], column[1], column[2]));
  for (const std::string& file : files) {
    const auto slice = header_of_slice(file);
    check_alike(*first, *slice, file);
    const std::vector<double> place = numbers_of(*slice, "0020|0032", 3);
    slices.first_mm.emplace_back(place[0], place[1], place[2]);
  }
  check_even(slices);
}

itk::IOComponentEnum type_of_slice(const std::string& file) {
  const auto format = itk::GDCMImageIO::New();
  format->SetFileName(file);
  format->ReadImageInformation();
  return format->GetComponentType();
}

template <class T>
ReadImage<T> read_series(const std::string& folder, const std::string& wanted) {
  const std::vector<std::string> files = files_of_series(folder, wanted);
  check_slices(files);
  return read_exactly<T>(type_of_slice(files.front()), [&]<class Value>() -> typename Image<Value>::Pointer {
    const auto reader = itk::ImageSeriesReader<Image<Value>>::New();
    reader->SetImageIO(itk::GDCMImageIO::New());
    reader->SetFileNames(files);
    reader->Update();
    return reader->GetOutput();
  });
}

template <class T>
ReadImage<T> read_any(const std::filesystem::path& file, const std::string& series) {
  const std::string name = file.string();
  if (std::filesystem::is_directory(file)) return read_series<T>(name, series);
  if (has_ending(file, ".nii") || has_ending(file, ".nii.gz")) {
    check_nifti_file(name);
    return read_image<T, itk::NiftiImageIO>(name);
  }
  if (has_ending(file, ".mhd") || has_ending(file, ".mha")) {
    check_meta_image_axes(name);
    return read_image<T, itk::MetaImageIO>(name);
  }
  return read_image<T, itk::NrrdImageIO>(name);
}

/// What ITK says of a file, on one line and without the addresses of its objects.
std::string in_plain_words(const itk::ExceptionObject& error) {
  const std::string said = std::regex_replace(error.GetDescription(), std::regex(R"(\(0x[0-9a-f]+\))"), "");
  return "ITK refuses it: " + std::regex_replace(said, std::regex(R"(\s+)"), " ");
}

template <class T>
std::string packed(const std::filesystem::path& file, const std::string& series) {
  const auto [image, is_high] = [&] {
    try {
      return read_any<T>(file, series);
    } catch (const itk::ExceptionObject& error) {
      throw std::runtime_error(in_plain_words(error));
    }
  }();
  std::string bytes;
  const auto size = image->GetLargestPossibleRegion().GetSize();
  for (int a = 0; a < 3; ++a) put(bytes, static_cast<int>(size[a]));
  for (int a = 0; a < 3; ++a) put(bytes, image->GetSpacing()[a]);
  for (int a = 0; a < 3; ++a) put(bytes, image->GetOrigin()[a]);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) put(bytes, image->GetDirection()(r, c));
  put(bytes, is_high);
  bytes.append(reinterpret_cast<const char*>(image->GetBufferPointer()),
               image->GetLargestPossibleRegion().GetNumberOfPixels() * sizeof(T));
  return bytes;
}

/// Reverses the order along x, so that the axes are right-handed.
template <class T>
void mirror(Volume<T>& volume) {
  const int count = volume.shape.count[0];
  for (std::size_t row = 0; row < volume.value.size(); row += count)
    std::reverse(volume.value.begin() + static_cast<std::ptrdiff_t>(row),
                 volume.value.begin() + static_cast<std::ptrdiff_t>(row) + count);
  volume.shift += volume.turn.col(0) * (count - 1) * volume.shape.spacing.x();
  volume.turn.col(0) *= -1;
}

/// The first file of a folder, in the order of their names, on whose header the library crashes; empty: there is none.
std::string crashing_slice(const std::filesystem::path& folder) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file()) files.insert(entry.path().string());
  for (const std::string& file : files) try {
      run_in_child([&] { return std::to_string(dicom_is_whole(file)); });
    } catch (const ChildDied&) {
      return file;
    } catch (const std::runtime_error&) {  // no DICOM picture
    }
  return "";
}

/// What `packed` makes in a child, with the slice's name where the library dies of one.
template <class T>
std::string packed_by_child(const std::filesystem::path& file, const std::string& series) try {
  return run_in_child([&] { return packed<T>(file, series); });
} catch (const ChildDied&) {
  if (!std::filesystem::is_directory(file)) throw;
  const std::string slice = crashing_slice(file);
  if (slice.empty()) throw;
  refuse_header(slice);
}

}  // namespace

template <class T>
Volume<T> read_with_image_library(const std::filesystem::path& file, const std::string& series) {
  const std::string bytes = packed_by_child<T>(file, series);
  Volume<T> volume{{{}, Eigen::Vector3d::Zero(), {}}, {}};
  std::size_t at = 0;
  for (int& count : volume.shape.count) count = take<int>(bytes, at);
  for (int a = 0; a < 3; ++a) volume.shape.spacing[a] = 1e-3 * take<double>(bytes, at);
  for (int a = 0; a < 3; ++a) volume.shift[a] = 1e-3 * take<double>(bytes, at);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) volume.turn(r, c) = take<double>(bytes, at);
  volume.is_high = take<bool>(bytes, at);
  if (!(volume.shape.spacing.minCoeff() > 0) || !volume.shift.allFinite() || !volume.turn.isUnitary(1e-4))
    throw std::runtime_error("its voxel sizes, origin or axes are none");
  volume.value.resize(volume.shape.size());
  if (bytes.size() - at != volume.value.size() * sizeof(T)) throw std::runtime_error("it ends before its last voxel");
  std::memcpy(volume.value.data(), bytes.data() + at, bytes.size() - at);
  if constexpr (std::is_same_v<T, float>) check_finite(volume.shape, volume.value);
  if (volume.turn.determinant() < 0) mirror(volume);
  return volume;
}

template LabelVolume read_with_image_library(const std::filesystem::path&, const std::string&);
template GreyVolume read_with_image_library(const std::filesystem::path&, const std::string&);

}  // namespace palpate
