#include "tools/organ/dicom_file.hpp"

#include <fmt/format.h>
#include <gdcmAttribute.h>
#include <gdcmReader.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>

namespace palpate {
namespace {

const gdcm::Tag kPixels(0x7fe0, 0x0010);

/// An unsigned number of the header; `otherwise` where it has none.
template <std::uint16_t Group, std::uint16_t Element>
std::int64_t number_of(const gdcm::DataSet& header, std::int64_t otherwise) {
  gdcm::Attribute<Group, Element> number;
  if (!header.FindDataElement(number.GetTag())) return otherwise;
  number.SetFromDataSet(header);
  return number.GetValue();
}

}  // namespace

bool dicom_is_whole(const std::string& file) {
  gdcm::Reader reader;
  reader.SetFileName(file.c_str());
  if (!reader.ReadUpToTag(kPixels, {kPixels})) refuse_header(file);
  if (reader.GetFile().GetHeader().GetDataSetTransferSyntax().IsEncapsulated()) return true;
  const gdcm::DataSet& header = reader.GetFile().GetDataSet();
  const std::int64_t bits = number_of<0x0028, 0x0100>(header, 8) * number_of<0x0028, 0x0002>(header, 1);
  const std::int64_t pixels = number_of<0x0028, 0x0010>(header, 0) * number_of<0x0028, 0x0011>(header, 0);
  if (pixels <= 0) refuse_header(file);
  const std::int64_t bytes = pixels * bits / 8;  // of one picture at least
  const auto begin =
      static_cast<std::int64_t>(reader.GetStreamCurrentPosition());  // of the pixels, which are passed over
  return static_cast<std::int64_t>(std::filesystem::file_size(file)) - begin >= bytes;
}

void refuse_header(const std::string& file) {
  throw std::runtime_error(fmt::format("its slice {} cannot be read: its header is cut short or damaged",
                                       std::filesystem::path(file).filename().string()));
}

}  // namespace palpate
