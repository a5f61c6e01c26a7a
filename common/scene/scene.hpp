#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/bus/spec.hpp"
#include "common/contact/spec.hpp"
#include "common/describe/key_list.hpp"
#include "common/models/body.hpp"
#include "common/realtime/rates.hpp"
#include "common/scene/render_spec.hpp"
#include "common/scene/web_spec.hpp"
#include "common/tool/passivity_spec.hpp"
#include "common/tool/spec.hpp"

namespace palpate {

/// A validated scene with every default filled in. Paths are absolute. Optional sections that are absent
/// stay empty, and nothing is built for them.
struct Scene {
  std::filesystem::path file;
  std::string title;
  std::vector<Body> bodies;
  std::vector<Tool> tools;
  ContactSpec contact;
  Passivity passivity;
  Network network;
  Rates rates;
  std::optional<Record> record;
  std::optional<Render> render;
  Web web;
};

/// Whether the state of some body is the deformation node's.
bool has_moving_tissue(const Scene& scene);

/// The top of a scene file.
void describe(Description& d, Scene& scene);

/// Reads and validates. Throws std::runtime_error("FILE:LINE:COLUMN: sentence").
Scene load_scene(const std::filesystem::path& file);

/// The same for text that stands for the contents of `file`: paths in it are relative to that file's folder.
Scene parse_scene(std::string_view text, const std::filesystem::path& file);

/// The resolved scene as TOML, every default written out; load_scene reads it back to the same scene.
std::string to_toml(const Scene& scene);

/// Every table and key of a scene file: what docs/scene.md lists.
const KeyList& scene_keys();

/// Hash (XXH3, 128 bits, 32 hexadecimal digits) of what two nodes must agree on: bodies, tools, contact law,
/// rates and the contents of the curve files. What each node may choose for itself is left out: title, paths,
/// devices, network, record, render, web. Meshes are compared by the hash of the archive. Throws std::runtime_error if
/// a curve file cannot be read.
std::string scene_hash(const Scene& scene);

}  // namespace palpate
