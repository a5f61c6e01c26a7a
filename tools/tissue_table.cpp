#include "tools/tissue_table.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace palpate {
namespace {

constexpr std::array kTissues{
    Tissue{"liver", 6000, 1500, 20000, 0.45, 1060,
           "Yeh et al., Ultrasound Med. Biol. 28, 2002; Samur et al., Med. Image Anal. 11, 2007"},
    Tissue{"kidney", 10000, 4000, 50000, 0.45, 1060, "Miller, J. Biomech. 33, 2000"},
    Tissue{"gall_bladder", 50000, 10000, 600000, 0.45, 1030,
           "Li et al., J. Mech. Behav. Biomed. Mater. 20, 2013 (its wall)"},
    Tissue{"brain", 2000, 500, 10000, 0.45, 1040, "Budday et al., Arch. Comput. Methods Eng. 27, 2020"},
    Tissue{"fat", 3000, 500, 25000, 0.45, 910,
           "Samani et al., Phys. Med. Biol. 52, 2007; Comley and Fleck, Int. J. Solids Struct. 47, 2010"},
    Tissue{"muscle", 12000, 5000, 60000, 0.45, 1090,
           "Gennisson et al., Ultrasound Med. Biol. 36, 2010; Van Loocke et al., J. Biomech. 39, 2006"}};

}  // namespace

std::span<const Tissue> tissues() {
  return kTissues;
}

const Tissue* find_tissue(std::string_view name) {
  const auto found = std::ranges::find(kTissues, name, &Tissue::name);
  return found == kTissues.end() ? nullptr : found;
}

std::string_view tissue_names() {
  static const std::string names = [] {
    std::string all;
    for (const Tissue& tissue : kTissues) all += (all.empty() ? "" : ", ") + std::string(tissue.name);
    return all;
  }();
  return names;
}

}  // namespace palpate
