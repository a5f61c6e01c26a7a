#include "common/models/content_hash.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "common/archive/archive.hpp"
#include "common/describe/digest.hpp"
#include "common/describe/toml_writer.hpp"

namespace palpate {
namespace {

/// What is stored, and files by what is in them. Positions along the axes and zeros without sign.
class StoredText : public TomlWriter {
 public:
  explicit StoredText(bool inertia) : inertia_(inertia) {}

  void number(const Key& key, double& value, const Range& range) override {
    double unsigned_zero = value + 0.0;
    TomlWriter::number(key, unsigned_zero, range);
  }
  void vector(const Key& key, Eigen::Vector3d& value) override {
    Eigen::Vector3d unsigned_zeros = value + Eigen::Vector3d::Zero();
    TomlWriter::vector(key, unsigned_zeros);
  }
  void file(const Key& key, std::filesystem::path& value) override {
    if (!value.empty() && takes(key)) line(key, file_digest(value));
  }

 protected:
  bool takes(const Key& key) const override { return key.use == Use::stored || (key.use == Use::inertia && inertia_); }
  bool takes_empty_tables() const override { return false; }

 private:
  bool inertia_;
};

/// Ratios that differ by rounding alone are one.
double rounded(double ratio) {
  return std::strtod(fmt::format("{:.12g}", ratio).c_str(), nullptr);
}

/// Young's moduli as multiples of the body's own. What has no mesh has no archive in a file.
void leave_out_scale(NamedSpec&) {}
void leave_out_scale(MeshedSpec& body) {
  body.material.young = 1;
}
void leave_out_scale(SolidSpec& body) {
  for (MaterialRegion& region : body.materials)
    region.material.young = rounded(region.material.young / body.material.young);
  leave_out_scale(static_cast<MeshedSpec&>(body));
}

}  // namespace

std::string archive_hash(const Body& body) {
  Body copy = body;
  std::visit([](auto& spec) { leave_out_scale(spec); }, copy);
  return content_hash(copy);
}

std::string content_hash(const Body& body) {
  Body copy = body;
  StoredText text(std::visit([](const auto& spec) { return stores_inertia(spec); }, body));
  describe(text, copy);
  return digest(fmt::format("format {}\n{}", kArchiveFormat, text.text()));
}

}  // namespace palpate
