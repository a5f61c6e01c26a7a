#pragma once
#include <optional>
#include <string>

#include "tools/rig/kinds.hpp"
#include "tools/study/dynamic.hpp"
#include "tools/study/one_mesh.hpp"
#include "tools/study/study.hpp"

/// What a study does with each kind of tissue: functions of its spec, called by std::visit on a Body; see
/// tools/rig/kinds.hpp for what it shares with the stability cases.
namespace palpate::study {

/// A body of a scene that is studied.
struct StudiedBody {
  const Scene& scene;
  int index;
  const StudyOptions& options;
};

// methods_of(spec, body): all methods that can serve a body, in the order of their rows. A kind that says none has no
// row.
inline Methods methods_of(const NamedSpec& /*spec*/, const StudiedBody& /*body*/) {
  return {};
}
Methods methods_of(const CatheterSpec& spec, const StudiedBody& body);
Methods methods_of(const ModalShellSpec& spec, const StudiedBody& body);
/// Of a solid: quasi-static, the references, and the models of moving tissue.
Methods methods_of(std::optional<OneMesh> whole, const StudiedBody& body, const std::vector<MovingModel>& models);
template <std::derived_from<SolidSpec> Spec>
Methods methods_of(const Spec& spec, const StudiedBody& body) {
  return methods_of(on_one_mesh(spec), body,
                    {moving_model<TensorMassSpec, Spec>(), moving_model<SpringMassSpec, Spec>()});
}
inline Methods methods_of(const HybridSpec& spec, const StudiedBody& body) {
  return methods_of(on_one_mesh(spec), body,
                    {moving_model<HybridSpec, HybridSpec>(), moving_model<TensorMassSpec, HybridSpec>(),
                     moving_model<SpringMassSpec, HybridSpec>()});
}

/// What is pressed is without loads, and stays whole.
inline void prepare_for_press(NamedSpec&) {}
inline void prepare_for_press(MovingSpec& spec) {
  take_loads_off(spec);
  spec.tearing.reset();
}

/// [bytes] that what owns the body's state takes, and what shows it. `scene`: of this body alone.
std::size_t owner_bytes(const NamedSpec& spec, const Scene& scene, const std::vector<Archive>& archives);
std::size_t owner_bytes(const MovingSpec& spec, const Scene& scene, const std::vector<Archive>& archives);

/// The elements of a hybrid's tensor-mass part, grown by so many layers of neighbours; shrunk by as many if negative.
/// Empty for other kinds.
inline std::vector<int> grown_part(const NamedSpec&, const TetMesh&, int /*layers*/) {
  return {};
}
std::vector<int> grown_part(const HybridSpec& spec, const TetMesh& mesh, int layers);
inline void set_moving_part(NamedSpec&, const std::vector<int>&) {}
inline void set_moving_part(HybridSpec& spec, const std::vector<int>& elements) {
  spec.hybrid.regions = {{{.indices = elements, .box = {}, .group = {}}}};
}

/// Names by nodes and elements of a finer mesh what is fixed and of which material; every free node can be touched.
inline void name_anew(NamedSpec&, const StaticProblem& /*finer*/) {}
void name_anew(SolidSpec& spec, const StaticProblem& finer);

// What else the figures of a body depend on, for the key of a study's store.
inline std::string key_of(const NamedSpec&) {
  return "";
}
inline std::string key_of(const CatheterSpec& spec) {
  return spec.catheter.inside.empty() ? "" : " with insertion";
}
inline std::string key_of(const HybridSpec& spec) {
  return spec.hybrid.mesh.empty() ? "" : " on one mesh";
}

}  // namespace palpate::study
