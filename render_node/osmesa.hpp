#pragma once

/// The few OSMesa calls, apart from gl.hpp because <GL/osmesa.h> and <GL/glcorearb.h> exclude each other.
namespace palpate::osmesa {

void* create_context();  ///< OpenGL 4.5 core; throws std::runtime_error
void destroy_context(void* context);
/// `buffer`: width x height RGBA bytes that outlive the context. Throws std::runtime_error.
void make_current(void* context, unsigned char* buffer, int width, int height);
void* function(const char* name);  ///< null if unknown

}  // namespace palpate::osmesa
