#include "tools/organ/label_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <stdexcept>

#include "common/files/atomic_file.hpp"

namespace palpate {
namespace {

constexpr double kMm = 1e3;

/// A volume's frame in millimetres.
struct ImageFrame {
  std::array<int, 3> count;
  std::array<double, 3> spacing, origin;
  std::array<std::array<double, 3>, 3> axis;  ///< unit vectors along x, y and z of the image
};

ImageFrame frame_of(const GreyVolume& v) {
  ImageFrame f{v.shape.count, {}, {}, {}};
  const Eigen::Vector3d origin = v.in_world(v.shape.origin);
  for (int a = 0; a < 3; ++a) {
    f.spacing[a] = kMm * v.shape.spacing[a];
    f.origin[a] = kMm * origin[a];
    for (int b = 0; b < 3; ++b) f.axis[a][b] = v.turn(b, a);
  }
  return f;
}

std::string meta_header(const ImageFrame& f) {
  return fmt::format(
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\n"
      "TransformMatrix = {} {} {}\nOffset = {}\nElementSpacing = {}\nDimSize = {}\nElementType = MET_UCHAR\n"
      "ElementDataFile = LOCAL\n",
      fmt::join(f.axis[0], " "), fmt::join(f.axis[1], " "), fmt::join(f.axis[2], " "), fmt::join(f.origin, " "),
      fmt::join(f.spacing, " "), fmt::join(f.count, " "));
}

std::string nrrd_header(const ImageFrame& f) {
  std::array<std::string, 3> step;
  for (int a = 0; a < 3; ++a) {
    std::array<double, 3> way = f.axis[a];
    for (double& w : way) w *= f.spacing[a];
    step[a] = fmt::format("({})", fmt::join(way, ","));
  }
  return fmt::format(
      "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: {}\nspace directions: {}\n"
      "kinds: domain domain domain\nencoding: raw\nspace origin: ({})\n\n",
      fmt::join(f.count, " "), fmt::join(step, " "), fmt::join(f.origin, ","));
}

std::string inr_header(const ImageFrame& f) {
  std::string text = fmt::format(
      "#INRIMAGE-4#{{\nXDIM={}\nYDIM={}\nZDIM={}\nVDIM=1\nTYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=decm\n"
      "VX={}\nVY={}\nVZ={}\n",
      f.count[0], f.count[1], f.count[2], f.spacing[0], f.spacing[1], f.spacing[2]);
  text.resize(252, '\n');
  return text + "##}\n";
}

std::string header_of(const GreyVolume& volume, const std::filesystem::path& file) {
  const ImageFrame frame = frame_of(volume);
  if (file.extension() == ".mha") return meta_header(frame);
  if (file.extension() == ".nrrd") return nrrd_header(frame);
  if (file.extension() != ".inr")
    throw std::runtime_error(fmt::format("{}: labels are written to .mha, .nrrd and .inr", file.string()));
  if (!volume.turn.isIdentity() || !volume.shift.isZero() || !volume.shape.origin.isZero())
    throw std::runtime_error(
        fmt::format("{}: INR has no place for the origin and axes of this image: take .mha or .nrrd", file.string()));
  return inr_header(frame);
}

}  // namespace

void write_label_volume(const GreyVolume& frame, const std::vector<char>& inside, const std::filesystem::path& file) {
  const std::string header = header_of(frame, file);
  AtomicFile whole(std::filesystem::absolute(file), header.size() + inside.size());
  std::ofstream out(whole.handle(), std::ios::binary);
  out << header;
  out.write(inside.data(), static_cast<std::streamsize>(inside.size()));
  out.close();
  if (!out) throw std::runtime_error(fmt::format("{}: it cannot be written", file.string()));
  whole.commit();
}

}  // namespace palpate
