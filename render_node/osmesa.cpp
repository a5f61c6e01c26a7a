#include "render_node/osmesa.hpp"

#include <GL/osmesa.h>

#include <stdexcept>

namespace palpate::osmesa {

void* create_context() {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            4,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            5,
                            0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!context) throw std::runtime_error("OSMesa cannot give an OpenGL 4.5 core context");
  return context;
}

void destroy_context(void* context) {
  if (OSMesaGetCurrentContext() == context) OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
  OSMesaDestroyContext(static_cast<OSMesaContext>(context));
}

void make_current(void* context, unsigned char* buffer, int width, int height) {
  if (OSMesaGetCurrentContext() == context) return;
  if (!OSMesaMakeCurrent(static_cast<OSMesaContext>(context), buffer, GL_UNSIGNED_BYTE, width, height))
    throw std::runtime_error("OSMesa cannot make its context current");
}

void* function(const char* name) {
  return reinterpret_cast<void*>(OSMesaGetProcAddress(name));
}

}  // namespace palpate::osmesa
