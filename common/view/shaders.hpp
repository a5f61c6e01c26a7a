#pragma once
#include <span>

/// The files of shaders/, built in.
namespace palpate::shaders {

extern const char* const scene;
extern const char* const noise;
extern const char* const light;
extern const char* const colours;
extern const char* const rigid_vert;
extern const char* const tissue_vert;
extern const char* const tissue_frag;
extern const char* const membrane_frag;
extern const char* const wall_vert;
extern const char* const duct_frag;
extern const char* const mucosa_frag;
extern const char* const plastic_frag;
extern const char* const bone_frag;
extern const char* const lining_frag;
extern const char* const metal_frag;
extern const char* const cavity_vert;
extern const char* const cavity_frag;
extern const char* const flat_vert;
extern const char* const flat_frag;
extern const char* const edge_vert;
extern const char* const edge_frag;

/// One of them under its name here.
struct Source {
  const char* name;
  const char* text;
};
std::span<const Source> all();

}  // namespace palpate::shaders
