#pragma once
#include <cstdint>
#include <string>

namespace palpate::testing {

/// One picture of a DICOM series (PS3.10, explicit little endian): an element after another, as a scanner writes them.
class DicomPicture {
 public:
  /// `z` [mm]; `pixels`: rows of `columns` bytes.
  DicomPicture(const std::string& series, int number, double z, int columns, const std::string& pixels) {
    const std::string instance = series + "." + std::to_string(number), syntax = "1.2.840.10008.1.2.1",
                      kind = "1.2.840.10008.5.1.4.1.1.2";
    std::string meta;
    add(meta, 0x0002, 0x0002, "UI", kind);
    add(meta, 0x0002, 0x0003, "UI", instance);
    add(meta, 0x0002, 0x0010, "UI", syntax);
    bytes_ = std::string(128, '\0') + "DICM";
    add(bytes_, 0x0002, 0x0000, "UL", word(static_cast<std::uint32_t>(meta.size()), 4));
    bytes_ += meta;
    add(bytes_, 0x0008, 0x0016, "UI", kind);
    add(bytes_, 0x0008, 0x0018, "UI", instance);
    add(bytes_, 0x0008, 0x0060, "CS", "CT");
    add(bytes_, 0x0020, 0x000d, "UI", "1.2.3");
    add(bytes_, 0x0020, 0x000e, "UI", series);
    add(bytes_, 0x0020, 0x0013, "IS", std::to_string(number));
    add(bytes_, 0x0020, 0x0032, "DS", "10\\20\\" + std::to_string(z));
    add(bytes_, 0x0020, 0x0037, "DS", "1\\0\\0\\0\\1\\0");
    add(bytes_, 0x0028, 0x0002, "US", word(1, 2));
    add(bytes_, 0x0028, 0x0004, "CS", "MONOCHROME2");
    add(bytes_, 0x0028, 0x0010, "US", word(static_cast<std::uint32_t>(pixels.size()) / columns, 2));
    add(bytes_, 0x0028, 0x0011, "US", word(columns, 2));
    add(bytes_, 0x0028, 0x0030, "DS", "2\\1");
    for (const auto& [element, value] : {std::pair{0x0100, 8}, {0x0101, 8}, {0x0102, 7}, {0x0103, 0}})
      add(bytes_, 0x0028, element, "US", word(value, 2));
    add(bytes_, 0x7fe0, 0x0010, "OB", pixels);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  static std::string word(std::uint32_t value, int size) {
    std::string text;
    for (int i = 0; i < size; ++i) text += static_cast<char>(value >> 8 * i);
    return text;
  }
  static void add(std::string& bytes, int group, int element, const std::string& type, std::string value) {
    if (value.size() % 2 != 0) value += type == "UI" || type == "OB" ? '\0' : ' ';
    bytes += word(group, 2) + word(element, 2) + type;
    const auto size = static_cast<std::uint32_t>(value.size());
    bytes += type == "OB" ? word(0, 2) + word(size, 4) : word(size, 2);
    bytes += value;
  }
  std::string bytes_;
};

}  // namespace palpate::testing
