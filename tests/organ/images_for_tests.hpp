#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

namespace palpate::testing {

/// Headers of images of 3 x 2 x 2 bytes, voxels of 1 x 2 x 3 mm, behind which these come. `first_axis`: "1" or "-1".
inline std::string meta_header(const std::string& first_axis = "1") {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nTransformMatrix = " +
         first_axis + " 0 0 0 1 0 0 0 1\nOffset = 10 20 30\nElementSpacing = 1 2 3\nDimSize = 3 2 2\n" +
         "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
}

inline std::string nrrd_header() {
  return "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nspacings: 1 2 3\nencoding: raw\nendian: little\n\n";
}

/// Of NIfTI-1, whose sform turns the image a quarter about z.
inline std::string nifti_header() {
  std::string bytes(352, '\0');
  const auto put = [&]<class T>(std::size_t at, T value) { std::memcpy(bytes.data() + at, &value, sizeof value); };
  put(0, std::int32_t{348});
  for (const auto& [at, value] : {std::pair{40, 3}, {42, 3}, {44, 2}, {46, 2}, {48, 1}, {50, 1}, {52, 1}, {54, 1}})
    put(at, static_cast<std::int16_t>(value));
  put(70, std::int16_t{2}), put(72, std::int16_t{8});
  for (const auto& [at, value] : {std::pair{76, 1.f}, {80, 1.f}, {84, 2.f}, {88, 3.f}, {108, 352.f}, {112, 1.f}})
    put(at, value);
  put(123, char{2}), put(254, std::int16_t{1});
  // x of the world is -2 j + 10, y is i + 20, z is 3 k + 30, all in millimetres and to the right and to the front.
  for (const auto& [at, value] : {std::pair{284, -2.f}, {292, 10.f}, {296, 1.f}, {308, 20.f}, {320, 3.f}, {324, 30.f}})
    put(at, value);
  bytes.replace(344, 4, std::string("n+1\0", 4));
  return bytes;
}

}  // namespace palpate::testing
