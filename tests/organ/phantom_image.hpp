#pragma once
#include <fmt/format.h>

#include <array>
#include <fstream>
#include <string>

namespace palpate::testing {

/// Writes an INR image of bytes: label(i, j, k) of each voxel; `size_mm` of a voxel.
template <class Label>
void write_phantom(const std::string& file, const std::array<int, 3>& count, double size_mm, const Label& label) {
  std::string bytes = fmt::format(
      "#INRIMAGE-4#{{\nXDIM={}\nYDIM={}\nZDIM={}\nVDIM=1\nTYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=decm\n"
      "VX={}\nVY={}\nVZ={}\n",
      count[0], count[1], count[2], size_mm, size_mm, size_mm);
  bytes.resize(252, '\n');
  bytes += "##}\n";
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i) bytes += static_cast<char>(label(i, j, k));
  std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace palpate::testing
