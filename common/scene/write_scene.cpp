#include <fmt/format.h>

#include "common/scene/scene.hpp"

namespace palpate {

namespace {

/// Shortest text that reads back to the same double, always a TOML float.
std::string number(double x) {
  std::string text = fmt::format("{}", x);
  if (text.find_first_of(".en") == text.npos) text += ".0";
  return text;
}

std::string vector(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", number(v.x()), number(v.y()), number(v.z()));
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (unsigned char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += static_cast<char>(c);
    } else if (c < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", c);
    } else {
      out += static_cast<char>(c);
    }
  }
  return out + '"';
}

std::string list(const std::vector<std::string>& entries) {
  std::string text;
  for (const std::string& entry : entries) text.append(text.empty() ? "[" : ", ").append(entry);
  return text + "]";
}

/// Collects lines `key = value`; what is empty is left out.
class Writer {
 public:
  void table(std::string_view header) { text_ += fmt::format("\n{}\n", header); }
  void line(std::string_view key, const std::string& value) { text_ += fmt::format("{} = {}\n", key, value); }
  void write(std::string_view key, double value) { line(key, number(value)); }
  void write(std::string_view key, int value) { line(key, std::to_string(value)); }
  void write(std::string_view key, bool value) { line(key, value ? "true" : "false"); }
  void write(std::string_view key, const Eigen::Vector3d& value) { line(key, vector(value)); }
  void write(std::string_view key, const std::string& value) {
    if (!value.empty()) line(key, toml_string(value));
  }
  void write(std::string_view key, const std::filesystem::path& value) { write(key, value.string()); }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void write(Writer& out, const Selector& where, std::string_view list_key) {
  std::vector<std::string> indices;
  for (int index : where.indices) indices.push_back(std::to_string(index));
  if (!indices.empty()) out.line(list_key, list(indices));
  if (where.box) out.line("box", fmt::format("[{}, {}]", vector(where.box->min), vector(where.box->max)));
  out.write("group", where.group);
}

void write(Writer& out, const Material& material) {
  out.write("young", material.young);
  out.write("poisson", material.poisson);
  out.write("density", material.density);
}

void write(Writer& out, const FixedRegion& fixed, bool shell) {
  out.table("[[body.fixed]]");
  write(out, fixed.where, "nodes");
  std::string axes;
  for (int axis = 0; axis < 3; ++axis) {
    if (fixed.axes[axis]) axes += "xyz"[axis];
  }
  out.write("axes", axes);
  if (shell) out.write("rotations", fixed.rotations);
}

void write(Writer& out, const Nonlinear& nonlinear) {
  out.table("[body.nonlinear]");
  out.write("force_curve", nonlinear.force_curve);
  out.write("radial_curve", nonlinear.radial_curve);
  out.write("radius", nonlinear.specimen_radius);
  out.write("height", nonlinear.specimen_height);
  out.write("degree", nonlinear.degree);
  if (nonlinear.specimen_mesh.empty()) return;
  out.write("specimen_mesh", nonlinear.specimen_mesh);
  out.write("specimen_scale", nonlinear.specimen_scale);
}

void write(Writer& out, const Offline& offline) {
  out.table("[body.offline]");
  out.write("refine", offline.refine);
  out.write("element", offline.element);
  out.write("formulation", offline.formulation);
}

void write(Writer& out, const Dynamic& dynamic) {
  out.table("[body.dynamic]");
  out.write("integrator", dynamic.integrator);
  out.write("precision", dynamic.precision);
  out.write("step", dynamic.step);
  out.write("damping", dynamic.damping);
  out.write("gravity", dynamic.gravity);
  out.write("corotational", dynamic.corotational);
}

void write(Writer& out, const Tearing& tearing) {
  out.table("[body.tearing]");
  out.write("criterion", tearing.criterion);
  out.write("threshold", tearing.threshold);
}

void write(Writer& out, const Hybrid& hybrid) {
  out.table("[body.hybrid]");
  out.write("mesh", hybrid.mesh);
  if (!hybrid.mesh.empty()) out.write("scale", hybrid.scale);
  for (const Selector& region : hybrid.regions) {
    out.table("[[body.hybrid.region]]");
    write(out, region, "elements");
  }
}

void write(Writer& out, const Shell& shell) {
  out.table("[body.shell]");
  out.write("thickness", shell.thickness);
  out.write("bending", shell.bending);
  out.write("modes", shell.modes);
  if (shell.damping > 0)
    out.write("damping", shell.damping);
  else
    out.write("damping_ratio", shell.damping_ratio);
  out.write("residual", shell.residual);
}

void write(Writer& out, const Catheter& catheter) {
  out.table("[body.catheter]");
  out.write("inside", catheter.inside);
  out.write("tail", catheter.tail);
  out.write("tip", catheter.tip);
  out.write("radius", catheter.radius);
  out.write("particles", catheter.particles);
  out.write("sleeve", catheter.sleeve);
  out.write("damping", catheter.damping);
  out.write("gravity", catheter.gravity);
  out.write("integrator", catheter.integrator);
}

void write(Writer& out, const Body& body) {
  out.table("[[body]]");
  out.write("name", body.name);
  out.write("mesh", body.mesh);
  if (!body.catheter) out.write("scale", body.scale);
  out.write("model", body.model);
  write(out, body.material);
  for (const FixedRegion& fixed : body.fixed) write(out, fixed, body.shell.has_value());
  for (const MaterialRegion& region : body.materials) {
    out.table("[[body.material]]");
    write(out, region.where, "elements");
    write(out, region.material);
  }
  if (body.nonlinear) write(out, *body.nonlinear);
  if (body.touchable) {
    out.table("[body.touchable]");
    write(out, *body.touchable, "nodes");
  }
  if (body.offline) write(out, *body.offline);
  if (is_dynamic(body)) write(out, body.dynamic);
  if (body.tearing) write(out, *body.tearing);
  if (body.hybrid) write(out, *body.hybrid);
  if (body.shell) write(out, *body.shell);
  if (body.catheter) write(out, *body.catheter);
}

void write(Writer& out, const Jaws& jaws, bool forceps) {
  out.table("[tool.jaws]");
  out.write("length", jaws.length);
  if (forceps) {
    out.write("radius", jaws.radius);
    out.write("most_open", jaws.most_open);
    out.write("grip_stiffness", jaws.grip_stiffness);
    out.write("friction", jaws.friction);
  } else {
    out.write("width", jaws.width);
    out.write("closed_below", jaws.closed_below);
  }
}

void write(Writer& out, const Tool& tool) {
  const bool forceps = tool.kind == "forceps";
  out.table("[[tool]]");
  out.write("name", tool.name);
  out.write("kind", tool.kind);
  out.write("pivot", tool.pivot);
  out.write("axis", tool.axis);
  out.write("up", tool.up);
  if (!forceps) out.write("radius", tool.radius);
  out.write("shaft_radius", tool.shaft_radius);
  out.write("shaft_length", tool.shaft_length);
  out.write("device", tool.device);
  out.write("trajectory", tool.trajectory);
  out.write("compliance", tool.compliance);
  out.write("max_force", tool.max_force);
  out.write("max_force_rate", tool.max_force_rate);
  if (tool.cautery) {
    out.table("[tool.cautery]");
    out.write("radius", tool.cautery->radius);
  }
  if (tool.jaws) write(out, *tool.jaws, forceps);
}

void write(Writer& out, const Network& network) {
  out.table("[network]");
  out.write("domain", network.domain);
  out.write("interface", network.interface);
  std::vector<std::string> peers;
  for (const std::string& peer : network.peers) peers.push_back(toml_string(peer));
  if (!peers.empty()) out.line("peers", list(peers));
  if (!network.security) return;
  out.table("[network.security]");
  out.write("keys", network.security->keys);
}

void write(Writer& out, const Render& render) {
  out.table("[render]");
  out.write("width", render.width);
  out.write("height", render.height);
  out.write("colour", render.colour);
  out.write("tissue_colour", Eigen::Vector3d(render.tissue_colour.data()));
  out.write("backdrop", render.backdrop);
  if (!render.backdrop.empty()) out.write("backdrop_scale", render.backdrop_scale);
  out.write("overlay", render.overlay);
  out.table("[render.camera]");
  out.write("eye", render.camera.eye);
  out.write("target", render.camera.target);
  out.write("up", render.camera.up);
  out.write("field_of_view", render.camera.field_of_view);
}

}  // namespace

std::string to_toml(const Scene& scene) {
  Writer out;
  out.write("title", scene.title);
  for (const Body& body : scene.bodies) write(out, body);
  for (const Tool& tool : scene.tools) write(out, tool);
  out.table("[contact]");
  out.write("rule", scene.contact.rule);
  out.write("friction", scene.contact.friction);
  out.write("bucket_size", scene.contact.bucket_size);
  out.table("[passivity]");
  out.write("controller", scene.passivity.controller);
  out.write("reserve", scene.passivity.reserve);
  write(out, scene.network);
  out.table("[rates]");
  out.write("haptic_hz", scene.rates.haptic_hz);
  out.write("visual_hz", scene.rates.visual_hz);
  if (scene.record) {
    out.table("[record]");
    out.write("file", scene.record->file);
  }
  if (scene.render) write(out, *scene.render);
  return out.text();
}

}  // namespace palpate
