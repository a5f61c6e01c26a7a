#include "render_node/gl.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "render_node/osmesa.hpp"

namespace palpate {

GlContext::GlContext() : context_(osmesa::create_context()) {
  make_current();
#define PALPATE_GL_LOAD(name, upper)                                            \
  gl.name = reinterpret_cast<PFNGL##upper##PROC>(osmesa::function("gl" #name)); \
  if (!gl.name) throw std::runtime_error("OSMesa lacks the OpenGL function gl" #name);
  PALPATE_GL_FUNCTIONS(PALPATE_GL_LOAD)
#undef PALPATE_GL_LOAD
}

GlContext::~GlContext() {
  osmesa::destroy_context(context_);
}

void GlContext::make_current() {
  osmesa::make_current(context_, placeholder_.data(), 16, 16);
}

void GlContext::check(std::string_view where) {
  if (const GLenum error = gl.GetError(); error != GL_NO_ERROR)
    throw std::runtime_error(fmt::format("OpenGL error 0x{:04x} in {}", error, where));
}

GLuint GlContext::compile(const std::string& name, GLenum stage, const std::string& source) {
  const GLuint shader = gl.CreateShader(stage);
  const char* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint done = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done) return shader;
  std::string words(4096, '\0');
  GLsizei length = 0;
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(words.size()), &length, words.data());
  words.resize(length);
  throw std::runtime_error(fmt::format("shader {} does not compile: {}", name, words));
}

GLuint GlContext::link_program(const std::string& name, const std::string& vertex, const std::string& fragment) {
  const GLuint program = gl.CreateProgram();
  for (const GLuint shader : {compile(name, GL_VERTEX_SHADER, vertex), compile(name, GL_FRAGMENT_SHADER, fragment)}) {
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);
  }
  gl.LinkProgram(program);
  GLint done = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &done);
  if (done) return program;
  std::string words(4096, '\0');
  GLsizei length = 0;
  gl.GetProgramInfoLog(program, static_cast<GLsizei>(words.size()), &length, words.data());
  words.resize(length);
  throw std::runtime_error(fmt::format("shader {} does not link: {}", name, words));
}

}  // namespace palpate
