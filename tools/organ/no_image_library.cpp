#include <stdexcept>

#include "tools/organ/label_volume.hpp"

namespace palpate {

template <class T>
Volume<T> read_with_image_library(const std::filesystem::path&, const std::string&) {
  throw std::runtime_error(
      "this palpate_organ was built without ITK and reads INR alone: build it where ITK is, on Debian with "
      "libinsighttoolkit5-dev");
}

template LabelVolume read_with_image_library(const std::filesystem::path&, const std::string&);
template GreyVolume read_with_image_library(const std::filesystem::path&, const std::string&);

}  // namespace palpate
