#pragma once
#include <GL/glcorearb.h>

#include <array>
#include <string>
#include <string_view>

/// OpenGL 4.5 core, off screen.
///
/// Every function is fetched from OSMesa by name. Linking `gl*` symbols directly would let any other OpenGL
/// library of the process (libgmsh brings one) answer in OSMesa's place.
namespace palpate {

// clang-format off
#define PALPATE_GL_FUNCTIONS(X) \
  X(AttachShader, ATTACHSHADER) X(BindBufferBase, BINDBUFFERBASE) X(BindFramebuffer, BINDFRAMEBUFFER) \
  X(BindTextureUnit, BINDTEXTUREUNIT) X(BindVertexArray, BINDVERTEXARRAY) X(BlendFunc, BLENDFUNC) \
  X(BlitNamedFramebuffer, BLITNAMEDFRAMEBUFFER) X(CheckNamedFramebufferStatus, CHECKNAMEDFRAMEBUFFERSTATUS) \
  X(Clear, CLEAR) X(ClearColor, CLEARCOLOR) X(CompileShader, COMPILESHADER) X(CreateBuffers, CREATEBUFFERS) \
  X(CreateFramebuffers, CREATEFRAMEBUFFERS) X(CreateProgram, CREATEPROGRAM) \
  X(CreateRenderbuffers, CREATERENDERBUFFERS) X(CreateShader, CREATESHADER) X(CreateTextures, CREATETEXTURES) \
  X(CreateVertexArrays, CREATEVERTEXARRAYS) X(CullFace, CULLFACE) X(DeleteBuffers, DELETEBUFFERS) \
  X(DeleteFramebuffers, DELETEFRAMEBUFFERS) X(DeleteProgram, DELETEPROGRAM) \
  X(DeleteRenderbuffers, DELETERENDERBUFFERS) X(DeleteShader, DELETESHADER) X(DeleteTextures, DELETETEXTURES) \
  X(DeleteVertexArrays, DELETEVERTEXARRAYS) X(DepthFunc, DEPTHFUNC) X(DepthMask, DEPTHMASK) X(Disable, DISABLE) \
  X(DrawArrays, DRAWARRAYS) X(DrawElements, DRAWELEMENTS) X(Enable, ENABLE) \
  X(EnableVertexArrayAttrib, ENABLEVERTEXARRAYATTRIB) X(FrontFace, FRONTFACE) \
  X(GenerateTextureMipmap, GENERATETEXTUREMIPMAP) X(GetError, GETERROR) \
  X(GetProgramInfoLog, GETPROGRAMINFOLOG) X(GetProgramiv, GETPROGRAMIV) X(GetShaderInfoLog, GETSHADERINFOLOG) \
  X(GetShaderiv, GETSHADERIV) X(GetString, GETSTRING) X(LinkProgram, LINKPROGRAM) \
  X(NamedBufferData, NAMEDBUFFERDATA) X(NamedBufferSubData, NAMEDBUFFERSUBDATA) \
  X(NamedFramebufferRenderbuffer, NAMEDFRAMEBUFFERRENDERBUFFER) \
  X(NamedRenderbufferStorageMultisample, NAMEDRENDERBUFFERSTORAGEMULTISAMPLE) X(PixelStorei, PIXELSTOREI) \
  X(ProgramUniform4f, PROGRAMUNIFORM4F) X(ProgramUniformMatrix4fv, PROGRAMUNIFORMMATRIX4FV) \
  X(ReadPixels, READPIXELS) X(ShaderSource, SHADERSOURCE) X(TextureParameteri, TEXTUREPARAMETERI) \
  X(TextureStorage2D, TEXTURESTORAGE2D) X(TextureSubImage2D, TEXTURESUBIMAGE2D) X(UseProgram, USEPROGRAM) \
  X(VertexArrayAttribBinding, VERTEXARRAYATTRIBBINDING) X(VertexArrayAttribFormat, VERTEXARRAYATTRIBFORMAT) \
  X(VertexArrayElementBuffer, VERTEXARRAYELEMENTBUFFER) X(VertexArrayVertexBuffer, VERTEXARRAYVERTEXBUFFER) \
  X(Viewport, VIEWPORT)
// clang-format on

/// The functions by their name without "gl": gl.DrawArrays(...).
struct GlFunctions {
#define PALPATE_GL_MEMBER(name, upper) PFNGL##upper##PROC name = nullptr;
  PALPATE_GL_FUNCTIONS(PALPATE_GL_MEMBER)
#undef PALPATE_GL_MEMBER
};

/// One OSMesa context. Use it from one thread at a time.
class GlContext {
 public:
  GlContext();  ///< Throws std::runtime_error if OSMesa cannot give OpenGL 4.5.
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Makes the context current on this thread; cheap if it already is.
  void make_current();
  /// Throws std::runtime_error naming `where` if an OpenGL call has failed since the last check.
  void check(std::string_view where);
  /// Compiles and links; throws std::runtime_error with the compiler's words.
  GLuint link_program(const std::string& name, const std::string& vertex, const std::string& fragment);

  GlFunctions gl;

 private:
  GLuint compile(const std::string& name, GLenum stage, const std::string& source);

  void* context_ = nullptr;
  std::array<unsigned char, 4 * 16 * 16> placeholder_{};  ///< OSMesa wants a colour buffer of its own
};

}  // namespace palpate
