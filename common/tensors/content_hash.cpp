#include "common/tensors/content_hash.hpp"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <bit>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

#include "common/tensors/archive.hpp"

namespace palpate {
namespace {

std::string hexadecimal(XXH128_hash_t hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

/// A running hash. Every value is preceded by its kind or length, so that no two inputs run together.
class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), XXH3_freeState) { XXH3_128bits_reset(state_.get()); }

  void add(double value) {
    if (value == 0) value = 0;  // one zero
    add_raw(&value, sizeof value);
  }
  void add(std::int64_t value) { add_raw(&value, sizeof value); }
  void add(const std::string& text) {
    add(static_cast<std::int64_t>(text.size()));
    add_raw(text.data(), text.size());
  }
  void add(const Material& material) {
    add(material.young);
    add(material.poisson);
  }
  void add(const Selector& selector) {
    add(static_cast<std::int64_t>(selector.indices.size()));
    for (int index : selector.indices) add(std::int64_t{index});
    add(std::int64_t{selector.box.has_value()});
    if (selector.box)
      for (int axis = 0; axis < 3; ++axis) {
        add(selector.box->min[axis]);
        add(selector.box->max[axis]);
      }
    add(selector.group);
  }
  void add_file(const std::filesystem::path& file) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), std::fclose);
    if (!stream) throw std::runtime_error(file.string() + ": the mesh file cannot be opened");
    std::vector<char> buffer(1 << 20);
    std::int64_t total = 0;
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), stream.get())) {
      add_raw(buffer.data(), count);
      total += static_cast<std::int64_t>(count);
    }
    if (std::ferror(stream.get())) throw std::runtime_error(file.string() + ": the mesh file cannot be read");
    add(total);
  }
  std::string text() const { return hexadecimal(XXH3_128bits_digest(state_.get())); }

 private:
  void add_raw(const void* data, std::size_t bytes) { XXH3_128bits_update(state_.get(), data, bytes); }
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

/// What the archives of bodies that move with inertia hold beyond those of quasi-static ones.
void add_dynamic(Hasher& hash, const Body& body) {
  hash.add(body.model);
  hash.add(body.material.density);
  for (const auto& region : body.materials) hash.add(region.material.density);
  if (body.model != "hybrid" || !body.hybrid) return;
  for (int axis = 0; axis < 3; ++axis) hash.add(body.dynamic.gravity[axis]);
  hash.add(static_cast<std::int64_t>(body.hybrid->regions.size()));
  for (const auto& region : body.hybrid->regions) hash.add(region);
  if (body.hybrid->mesh.empty()) return;
  hash.add_file(body.hybrid->mesh);
  hash.add(body.hybrid->scale);
}

/// What the archive of a shell holds beyond that of a quasi-static body.
void add_shell(Hasher& hash, const Body& body) {
  hash.add(body.model);
  hash.add(body.material.density);
  for (const auto& region : body.fixed) hash.add(std::int64_t{region.rotations});
  if (!body.shell) return;
  hash.add(body.shell->thickness);
  hash.add(body.shell->bending);
  hash.add(std::int64_t{body.shell->modes});
}

std::string catheter_hash(const Body& body) {
  Hasher hash;
  hash.add(std::int64_t{kArchiveFormat});
  hash.add(body.model);
  if (!body.catheter) return hash.text();
  for (const auto* end : {&body.catheter->tail, &body.catheter->tip})
    for (int axis = 0; axis < 3; ++axis) hash.add((*end)[axis]);
  hash.add(body.catheter->radius);
  hash.add(std::int64_t{body.catheter->particles});
  return hash.text();
}

}  // namespace

std::string content_hash(const Body& body) {
  if (body.model == "catheter") return catheter_hash(body);
  Hasher hash;
  hash.add(std::int64_t{kArchiveFormat});
  hash.add_file(body.mesh);
  hash.add(body.scale);
  hash.add(body.material);
  hash.add(static_cast<std::int64_t>(body.materials.size()));
  for (const auto& region : body.materials) {
    hash.add(region.where);
    hash.add(region.material);
  }
  hash.add(static_cast<std::int64_t>(body.fixed.size()));
  for (const auto& region : body.fixed) {
    hash.add(region.where);
    for (bool axis : region.axes) hash.add(std::int64_t{axis});
  }
  hash.add(std::int64_t{body.touchable.has_value()});
  if (body.touchable) hash.add(*body.touchable);
  const bool specimen = body.nonlinear && !body.nonlinear->specimen_mesh.empty();
  hash.add(std::int64_t{specimen});
  if (specimen) {
    hash.add_file(body.nonlinear->specimen_mesh);
    hash.add(body.nonlinear->specimen_scale);
  }
  hash.add(std::int64_t{body.offline.has_value()});
  if (body.offline) {
    hash.add(std::int64_t{body.offline->refine});
    hash.add(body.offline->element);
    hash.add(body.offline->formulation);
  }
  if (body.model == "modal_shell")
    add_shell(hash, body);
  else if (body.model != "quasi_static")
    add_dynamic(hash, body);
  return hash.text();
}

std::string checksum(const void* data, std::size_t bytes) {
  return hexadecimal(XXH3_128bits(data, bytes));
}

}  // namespace palpate
