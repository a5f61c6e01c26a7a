#pragma once
#include <fmt/format.h>

#include <array>
#include <fstream>
#include <string>

namespace palpate::testing {

/// The first 256 bytes of an INR image.
inline std::string inr_header(const std::array<int, 3>& count, const std::array<double, 3>& voxel_mm,
                              const std::string& type = "unsigned fixed", int bits = 8) {
  std::string text = fmt::format(
      "#INRIMAGE-4#{{\nXDIM={}\nYDIM={}\nZDIM={}\nVDIM=1\nTYPE={}\nPIXSIZE={} bits\nCPU=decm\nVX={}\nVY={}\nVZ={}\n",
      count[0], count[1], count[2], type, bits, voxel_mm[0], voxel_mm[1], voxel_mm[2]);
  text.resize(252, '\n');
  return text + "##}\n";
}

/// Writes an INR image of bytes: label(i, j, k) of each voxel; `voxel_mm`: its extents.
template <class Label>
void write_phantom(const std::string& file, const std::array<int, 3>& count, const std::array<double, 3>& voxel_mm,
                   const Label& label) {
  std::string bytes = inr_header(count, voxel_mm);
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i) bytes += static_cast<char>(label(i, j, k));
  std::ofstream(file, std::ios::binary) << bytes;
}

template <class Label>
void write_phantom(const std::string& file, const std::array<int, 3>& count, double size_mm, const Label& label) {
  write_phantom(file, count, {size_mm, size_mm, size_mm}, label);
}

}  // namespace palpate::testing
