#include "common/describe/digest.hpp"
#include "common/describe/toml_writer.hpp"
#include "common/scene/scene.hpp"

namespace palpate {
namespace {

/// What the nodes must agree on. A mesh, like all that is stored in an archive, is compared by the archive's own hash;
/// of other files the contents count.
class AgreedText : public TomlWriter {
 public:
  void file(const Key& key, std::filesystem::path& value) override {
    if (value.empty() || !takes(key)) return;
    line(key, key.use == Use::agreed ? file_digest(value) : "\"in the archive\"");
  }

 protected:
  bool takes(const Key& key) const override { return key.use != Use::local; }
  bool takes_table(const Key& key) const override { return takes(key); }
};

}  // namespace

std::string to_toml(const Scene& scene) {
  Scene copy = scene;
  TomlWriter writer;
  describe(writer, copy);
  return writer.text();
}

std::string scene_hash(const Scene& scene) {
  Scene copy = scene;
  AgreedText text;
  describe(text, copy);
  return digest(text.text());
}

}  // namespace palpate
