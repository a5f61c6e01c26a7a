#pragma once
#include <concepts>
#include <functional>
#include <memory>
#include <string_view>

#include "common/dynamics/make_model.hpp"
#include "common/dynamics/spec.hpp"
#include "common/models/kind.hpp"

namespace palpate {

/// What tells one kind of moving tissue from another are these functions of its spec, beside those of
/// common/models/kind.hpp; what follows from them serves all kinds that derive from MovingSpec.

/// make_model(spec, mesh): its motion. Elements, unless a kind has its own.
std::unique_ptr<DynamicModel> make_model(const MovingSpec& body, const ElasticMesh& mesh);

/// has_own_mesh(spec): whether what moves has a mesh beside the body's.
constexpr bool has_own_mesh(const MovingSpec&) {
  return false;
}

/// contact_is_tried(spec): whether the stability cases press bodies of this kind (docs/stability.md).
constexpr bool contact_is_tried(const MovingSpec&) {
  return false;
}

/// Makes the body's model, and refers to the body.
template <std::derived_from<MovingSpec> Spec>
MakeModel model_maker(const Spec& body) {
  return [&body](const ElasticMesh& mesh) { return make_model(body, mesh); };
}

/// The archive of a body that moves with inertia as a whole.
ArchiveJob moving_archive_job(const MovingSpec& body, std::string_view kind, const Progress& progress);
template <std::derived_from<MovingSpec> Spec>
ArchiveJob archive_job(const Spec& body, const Progress& progress) {
  return moving_archive_job(body, Spec::kKind, progress);
}

std::unique_ptr<DynamicOrgan> make_moving_organ(const MovingSpec& body, const Archive& archive,
                                                const StepSettings& settings, const MakeModel& make);
template <std::derived_from<MovingSpec> Spec>
std::unique_ptr<DynamicOrgan> make_organ(const Spec& body, const Archive& archive, const StepSettings& settings) {
  return make_moving_organ(body, archive, settings, model_maker(body));
}

/// What a check sees of a kind.
struct MovingKind {
  std::string_view name;
  MakeModel make_model;
  std::function<ArchiveJob(const Progress&)> archive_job;
  bool own_mesh, contact_tried;
};

/// Says what moving tissue consists of, its model, step, tearing and connection; the deformation node's parts are built
/// and measured. Throws std::runtime_error if the scene gives a step that is not stable.
void check_moving(const MovingSpec& body, const MovingKind& kind, const CheckSettings& settings, CheckReport& report);
void warn_of_locking(const std::vector<std::string>& sentences, CheckReport& report);
template <std::derived_from<MovingSpec> Spec>
void check(const Spec& body, const CheckSettings& settings, CheckReport& report) {
  const MovingKind kind{.name = Spec::kKind,
                        .make_model = model_maker(body),
                        .archive_job = [&body](const Progress& progress) { return archive_job(body, progress); },
                        .own_mesh = has_own_mesh(body),
                        .contact_tried = contact_is_tried(body)};
  check_moving(body, kind, settings, report);
  warn_of_locking(locking_warnings(body), report);
}

}  // namespace palpate
