#pragma once
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/archive/compressed_compliance.hpp"

namespace palpate::testing {

/// A folder of this process that goes away with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "palpate-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) names.push_back(entry.path().filename());
    return names;
  }

 private:
  std::filesystem::path path_;
};

inline std::vector<char> read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void write_bytes(const std::filesystem::path& file, const std::vector<char>& bytes, std::size_t count) {
  std::ofstream(file, std::ios::binary | std::ios::trunc).write(bytes.data(), static_cast<std::streamsize>(count));
}

/// An archive of the right shape with numbers of no meaning.
inline Archive make_archive(int touchable, int others, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Archive archive;
  archive.body = "liver";
  archive.content_hash = "0123456789abcdef0123456789abcdef";
  archive.software = "palpate test";
  archive.mesh_nodes = 3 * (touchable + others);
  archive.young = {1e4, 2e4};
  archive.poisson = {0.3, 0.45};
  archive.material_of_element = {0, 1, 1, 0};
  archive.surface.touchable = touchable;
  for (int node = 0; node < touchable + others; ++node) {
    archive.surface.position.push_back({uniform(random), uniform(random), uniform(random)});
    archive.surface.node_number.push_back(2 * node);
    archive.surface.fixed.push_back({node % 5 == 0, false, node % 7 == 0});
    for (int axis = 0; axis < 3; ++axis)
      if (!archive.surface.fixed[node][axis])
        (node < touchable ? archive.touchable_dofs : archive.other_dofs).push_back({node, axis});
  }
  for (int i = 0; i + 2 < touchable + others; ++i) archive.surface.triangles.push_back({i, i + 1, i + 2});
  const std::size_t t = archive.touchable_dofs.size();
  archive.touchable_compliance.resize(t * (t + 1) / 2);
  archive.other_compliance.resize(t * archive.other_dofs.size());
  for (auto* values : {&archive.touchable_compliance, &archive.other_compliance})
    std::generate(values->begin(), values->end(), [&] { return uniform(random); });
  for (std::size_t i = 0; i < t; ++i) archive.touchable_compliance[i * (i + 1) / 2 + i] = 1;
  archive.specimen_force_slope = 12.5;
  archive.specimen_radial_slope = 0.25;
  return archive;
}

/// The same with a part that moves with inertia; `touchable` and `others` at least 4.
inline Archive make_hybrid_archive(int touchable, int others, unsigned seed = 1) {
  auto archive = make_archive(touchable, others, seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  archive.model = "hybrid";
  archive.parts = {.dynamic = true, .condensed = true};
  archive.density = {1000, 1200};
  archive.tetrahedra = {{0, 1, 2, 3}, {1, 2, 3, 4}, {2, 3, 4, 5}, {3, 4, 5, 6}};
  auto& hybrid = archive.condensed.emplace();
  hybrid.connection = {1, 2, 4};
  hybrid.mass = {0.001, 0.002, 0.003};
  hybrid.bound = 1.5e6;
  hybrid.held_by_connection = true;
  hybrid.dofs = {{1, 0}, {1, 1}, {2, 2}, {4, 1}};
  hybrid.quasi_static_triangles = 3;
  hybrid.interface = {{1, 2, 4, 7}};
  hybrid.gap = {{5, {1, 2, 4}, {0.5, 0.25, 0.25}}, {6, {4, 2, 1}, {1, 0, 0}}};
  hybrid.max_gap = 2e-4;
  const std::size_t c = hybrid.dofs.size(), i = archive.touchable_dofs.size() + archive.other_dofs.size();
  hybrid.stiffness.resize(c * (c + 1) / 2);
  hybrid.reaction.resize(c);
  hybrid.follow.resize(i * c);
  hybrid.sag.resize(i);
  for (auto* values : {&hybrid.stiffness, &hybrid.reaction, &hybrid.follow, &hybrid.sag})
    std::generate(values->begin(), values->end(), [&] { return uniform(random); });
  return archive;
}

/// The same with the modes of a shell.
inline Archive make_modal_archive(int touchable, int others, int modes, unsigned seed = 1) {
  auto archive = make_archive(touchable, others, seed);
  archive.model = "modal_shell";
  archive.parts.modal = true;
  archive.density = {1050};
  archive.material_of_element.clear();
  auto& modal = archive.modal.emplace();
  modal.thickness = 8e-4;
  for (int i = 0; i < modes; ++i) modal.omega.push_back(50 + 3 * i);
  for (int i = 0; i < touchable + others; ++i) modal.mass.push_back(1e-6 * (1 + i));
  std::mt19937 random(~seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  modal.shape.resize(std::size_t{3} * (touchable + others) * modes);
  std::generate(modal.shape.begin(), modal.shape.end(), [&] { return uniform(random); });
  return archive;
}

inline bool same_dofs(const std::vector<Dof>& a, const std::vector<Dof>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Dof& x, const Dof& y) { return x.node == y.node && x.axis == y.axis; });
}

inline bool same(const Archive& a, const Archive& b) {
  return a.body == b.body && a.model == b.model && a.density == b.density && a.tetrahedra == b.tetrahedra &&
         a.condensed == b.condensed && a.modal == b.modal && a.presses == b.presses &&
         a.content_hash == b.content_hash && a.software == b.software && a.mesh_nodes == b.mesh_nodes &&
         a.young == b.young && a.poisson == b.poisson && a.material_of_element == b.material_of_element &&
         a.surface.position == b.surface.position && a.surface.node_number == b.surface.node_number &&
         a.surface.fixed == b.surface.fixed && a.surface.triangles == b.surface.triangles &&
         a.surface.touchable == b.surface.touchable && same_dofs(a.touchable_dofs, b.touchable_dofs) &&
         same_dofs(a.other_dofs, b.other_dofs) && !a.compressed == !b.compressed &&
         (!a.compressed || a.compressed->tensors() == b.compressed->tensors()) &&
         a.touchable_compliance == b.touchable_compliance && a.other_compliance == b.other_compliance &&
         a.specimen_force_slope == b.specimen_force_slope && a.specimen_radial_slope == b.specimen_radial_slope;
}

/// The sentence with which an archive is refused; empty if it is read.
inline std::string refusal(const std::filesystem::path& file, ArchivePart part = ArchivePart::surface,
                           const std::string& hash = {}) {
  try {
    read_archive(file, part, hash);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace palpate::testing
