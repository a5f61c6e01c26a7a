#pragma once
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <string>

namespace palpate::testing {

/// Numbers of a normal distribution of deviation 1, the same each time.
class BellNoise {
 public:
  double operator()() { return std::sqrt(-2 * std::log(even())) * std::cos(2 * std::numbers::pi * even()); }

 private:
  std::uint64_t state_ = 12345;

  double even() {  // 0 to 1
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return (static_cast<double>(state_ >> 11) + 1) / 9007199254740993.0;
  }
};

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
