#include "render_node/renderer.hpp"

#include <fmt/format.h>

#include <map>
#include <stdexcept>
#include <tuple>

#include "common/view/instrument.hpp"
#include "common/view/looks.hpp"
#include "common/view/shaders.hpp"
#include "render_node/gl.hpp"
#include "render_node/gpu_mesh.hpp"
#include "render_node/gpu_texture.hpp"
#include "render_node/overlay.hpp"
#include "render_node/render_target.hpp"
#include "render_node/scene_block.hpp"

namespace palpate {
namespace {

const std::string kHead = "#version 450 core\n";

}  // namespace

struct Renderer::Impl {
  Impl(int width, int height, int samples);
  ~Impl();

  void check(const Frame& frame) const;
  void draw_instruments(const Frame& frame);
  void draw_soft(const Frame& frame);
  void draw_backdrop(const Frame& frame);
  bool backdrop_changed(const Frame& frame, const SceneBlock& block);
  void draw_overlay(const Frame& frame);
  GLuint soft_program(const MeshView& mesh, std::size_t tools);
  GLuint make_soft(Finish finish, bool by_scalar, bool textured, std::size_t tools);
  void wear(const TextureView& texture);
  GpuMesh& upload(const MeshView& mesh);
  void rebuild_font();

  GlContext context;
  GlFunctions& gl = context.gl;
  RenderTarget target;
  GLuint bone, lining, metal, cavity, flat, edge;
  std::map<std::tuple<Finish, bool, bool, std::size_t>, GLuint>
      soft;  ///< by (finish, coloured by scalar, textured, number of instruments)
  GLuint block = 0, empty_array = 0, glyph_texture = 0;
  std::optional<FontAtlas> font;
  int font_size = 0;
  std::map<int, GpuMesh> meshes;
  std::map<int, GpuTexture> textures;
  using InstrumentKey = std::array<double, 6>;
  struct Instrument {
    InstrumentShape shape;
    std::vector<GpuMesh> parts;
  };
  std::map<InstrumentKey, Instrument> instruments;
  GpuQuads quads;
  std::vector<std::uint64_t> backdrop_meshes;      ///< what the kept backdrop shows
  std::array<Eigen::Vector4f, 6> backdrop_view{};  ///< and from where
};

Renderer::Impl::Impl(int width, int height, int samples) : target(context, width, height, samples), quads(context) {
  const std::string scene = kHead + shaders::scene;
  const std::string lit = scene + "#define TOOLS 0\n" + shaders::noise + shaders::light;
  const std::string rigid = scene + shaders::rigid_vert;
  bone = context.link_program("bone", rigid, lit + shaders::bone_frag);
  lining = context.link_program("lining", rigid, lit + shaders::lining_frag);
  metal = context.link_program("metal", rigid, lit + shaders::metal_frag);
  cavity = context.link_program("cavity", scene + shaders::cavity_vert, lit + shaders::cavity_frag);
  flat = context.link_program("flat", scene + shaders::flat_vert, kHead + shaders::colours + shaders::flat_frag);
  edge = context.link_program("edge", scene + shaders::edge_vert, kHead + shaders::edge_frag);
  gl.CreateBuffers(1, &block);
  gl.NamedBufferData(block, sizeof(SceneBlock), nullptr, GL_DYNAMIC_DRAW);
  gl.CreateVertexArrays(1, &empty_array);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LEQUAL);
  gl.FrontFace(GL_CW);  // the picture is drawn upside down
  gl.CullFace(GL_BACK);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  context.check("set-up");
}

Renderer::Impl::~Impl() {
  context.make_current();
}

void Renderer::Impl::check(const Frame& frame) const {
  if (frame.instruments.size() > kMaxTools)
    throw std::runtime_error(
        fmt::format("a picture shows at most {} instruments, not {}", kMaxTools, frame.instruments.size()));
  for (const MeshView& mesh : frame.meshes) {
    const std::size_t n = mesh.position.size();
    if (mesh.rest.size() != n || mesh.normal.size() != n || (!mesh.scalar.empty() && mesh.scalar.size() != n))
      throw std::runtime_error(fmt::format("mesh {}: rest, position, normal and scalar differ in length", mesh.id));
    const TextureView& texture = mesh.texture;
    if (!mesh.image.empty() && (mesh.image.size() != n || texture.rgba.empty() ||
                                texture.rgba.size() != std::size_t{4} * texture.width * texture.height))
      throw std::runtime_error(fmt::format("mesh {}: its texture, or the places in it, are not whole", mesh.id));
    if (!mesh.scalar.empty() && !(frame.legend && frame.legend->max > 0))
      throw std::runtime_error(fmt::format("mesh {}: colour by scalar needs a legend with a positive range", mesh.id));
  }
}

GpuMesh& Renderer::Impl::upload(const MeshView& mesh) {
  const auto [entry, is_new] = meshes.try_emplace(mesh.id, context);
  GpuMesh& gpu = entry->second;
  if (!gpu.holds(mesh)) {
    gpu.build(mesh);
  } else if (mesh.moving) {
    gpu.update(mesh);
  }
  return gpu;
}

GLuint Renderer::Impl::soft_program(const MeshView& mesh, std::size_t tools) {
  const bool by_scalar = !mesh.scalar.empty(), textured = !by_scalar && !mesh.image.empty();
  const Finish finish = by_scalar ? Finish::tissue : mesh.finish;
  GLuint& program = soft[{finish, by_scalar, textured, tools}];
  if (!program) program = make_soft(finish, by_scalar, textured, tools);
  return program;
}

GLuint Renderer::Impl::make_soft(Finish finish, bool by_scalar, bool textured, std::size_t tools) {
  const std::string start = fmt::format("{}{}{}#define TOOLS {}\n{}", kHead, by_scalar ? "#define BY_SCALAR\n" : "",
                                        textured ? "#define TEXTURED\n" : "", tools, shaders::scene) +
                            shaders::noise;
  const std::string lit = start + shaders::light;
  if (finish == Finish::tissue)
    return context.link_program("tissue", start + shaders::tissue_vert, lit + shaders::colours + shaders::tissue_frag);
  if (finish == Finish::membrane)
    return context.link_program("membrane", start + shaders::tissue_vert, lit + shaders::membrane_frag);
  if (finish == Finish::duct) return context.link_program("duct", start + shaders::wall_vert, lit + shaders::duct_frag);
  if (finish == Finish::mucosa)
    return context.link_program("mucosa", start + shaders::wall_vert, lit + shaders::mucosa_frag);
  return context.link_program("plastic", start + shaders::wall_vert, lit + shaders::plastic_frag);
}

void Renderer::Impl::draw_soft(const Frame& frame) {
  gl.Enable(GL_CULL_FACE);
  for (const MeshView& mesh : frame.meshes) {
    if (in_backdrop(mesh.finish)) continue;
    const GLuint program = soft_program(mesh, frame.instruments.size());
    const auto& c = mesh.colour;
    gl.ProgramUniform4f(program, 4, float(c[0]), float(c[1]), float(c[2]), 1);
    gl.UseProgram(program);
    if (!mesh.image.empty()) wear(mesh.texture);
    const GpuMesh& gpu = upload(mesh);
    gpu.draw();
    if (mesh.edges.empty()) continue;
    gl.UseProgram(edge);
    gpu.draw_edges();
  }
}

void Renderer::Impl::wear(const TextureView& texture) {
  GpuTexture& held = textures.try_emplace(texture.id, context).first->second;
  held.hold(texture);
  held.bind(1);
}

/// What stands still while the camera does is drawn once and copied into every frame.
void Renderer::Impl::draw_backdrop(const Frame& frame) {
  gl.Enable(GL_CULL_FACE);
  const Eigen::Matrix4f identity = Eigen::Matrix4f::Identity();
  for (const MeshView& mesh : frame.meshes) {
    if (!in_backdrop(mesh.finish)) continue;
    const GLuint program = mesh.finish == Finish::bone ? bone : lining;
    const auto& c = mesh.colour;
    gl.ProgramUniformMatrix4fv(program, 0, 1, GL_FALSE, identity.data());
    gl.ProgramUniform4f(program, 4, float(c[0]), float(c[1]), float(c[2]), 1);
    gl.UseProgram(program);
    upload(mesh).draw();
  }
  gl.Disable(GL_CULL_FACE);
  gl.UseProgram(cavity);
  gl.BindVertexArray(empty_array);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::Impl::draw_instruments(const Frame& frame) {
  gl.UseProgram(metal);
  gl.Enable(GL_CULL_FACE);
  for (const InstrumentView& tool : frame.instruments) {
    const Steel steel = steel_of(tool);
    gl.ProgramUniform4f(metal, 4, steel.polish, 0, 0, steel.bare);
    Instrument& made = instruments[{tool.tip_radius, tool.blade ? 1.0 : 0.0, tool.shaft_radius, tool.shaft_length,
                                    tool.jaw_length, tool.jaw_radius}];
    if (made.parts.empty()) {
      made.shape = make_instrument(tool);
      for (const InstrumentPart& part : made.shape.parts) {
        const MeshView view{.rest = part.position,
                            .position = part.position,
                            .normal = part.normal,
                            .scalar = {},
                            .triangles = part.triangles,
                            .moving = false};
        made.parts.emplace_back(context).build(view);
      }
    }
    const Eigen::Vector3f along = tool.tip.linear().col(2).cast<float>();
    gl.ProgramUniform4f(metal, 5, along.x(), along.y(), along.z(), float(tool.shaft_radius));
    for (int part = 0; part < 3; ++part) {
      const Eigen::Matrix4f pose = part_pose(tool, made.shape, part).matrix().cast<float>();
      gl.ProgramUniformMatrix4fv(metal, 0, 1, GL_FALSE, pose.data());
      made.parts[part].draw();
    }
  }
}

bool Renderer::Impl::backdrop_changed(const Frame& frame, const SceneBlock& block) {
  std::vector<std::uint64_t> now;
  for (const MeshView& mesh : frame.meshes)
    if (in_backdrop(mesh.finish)) now.insert(now.end(), {static_cast<std::uint64_t>(mesh.id), mesh.shape});
  std::array<Eigen::Vector4f, 6> view{block.eye, block.right, block.up, block.forward, block.light, block.viewport};
  view[2].w() = 0;  // the legend's range does not matter here
  const bool changed = now != backdrop_meshes || view != backdrop_view || !target.has_backdrop();
  backdrop_meshes = std::move(now);
  backdrop_view = view;
  return changed;
}

void Renderer::Impl::rebuild_font() {
  const int size = overlay_font_size(target.height());
  if (font_size == size) return;
  font.emplace(default_font(), size);
  font_size = size;
  if (glyph_texture) gl.DeleteTextures(1, &glyph_texture);
  gl.CreateTextures(GL_TEXTURE_2D, 1, &glyph_texture);
  gl.TextureStorage2D(glyph_texture, 1, GL_R8, font->width(), font->height());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TextureSubImage2D(glyph_texture, 0, 0, 0, font->width(), font->height(), GL_RED, GL_UNSIGNED_BYTE,
                       font->coverage().data());
  gl.TextureParameteri(glyph_texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TextureParameteri(glyph_texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void Renderer::Impl::draw_overlay(const Frame& frame) {
  if (!frame.overlay && !frame.legend) return;
  rebuild_font();
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.Enable(GL_BLEND);
  gl.UseProgram(flat);
  gl.BindTextureUnit(0, glyph_texture);
  quads.draw(lay_out(frame, *font, target.width(), target.height()));
  gl.Disable(GL_BLEND);
  gl.Enable(GL_DEPTH_TEST);
}

Renderer::Renderer(int width, int height, int samples) : impl_(std::make_unique<Impl>(width, height, samples)) {}
Renderer::~Renderer() = default;
int Renderer::width() const {
  return impl_->target.width();
}
int Renderer::height() const {
  return impl_->target.height();
}

void Renderer::resize(int width, int height) {
  impl_->context.make_current();
  impl_->target.resize(width, height);
}

void Renderer::draw(const Frame& frame, Image& image) {
  Impl& r = *impl_;
  r.check(frame);
  r.context.make_current();
  const SceneBlock block = scene_block(frame, width(), height());
  r.gl.NamedBufferSubData(r.block, 0, sizeof block, &block);
  r.gl.BindBufferBase(GL_UNIFORM_BUFFER, 0, r.block);
  if (r.backdrop_changed(frame, block)) {
    r.target.begin_backdrop();
    r.draw_backdrop(frame);
  }
  r.target.begin();
  r.draw_instruments(frame);
  r.draw_soft(frame);
  r.target.resolve();
  r.draw_overlay(frame);
  r.target.read(image);
  r.context.check("a frame");
}

}  // namespace palpate
