#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "common/fem/progress.hpp"

namespace palpate {

struct Archive;
struct NamedSpec;
struct MeshedSpec;
struct MovingSpec;
struct StepSettings;
class BodyPart;
class BodyShape;
class DynamicOrgan;

/// What programs ask of every kind of tissue are functions of its spec, declared beside it and defined in the kind's
/// folder; a function of a base serves the kinds that derive from it. Programs call them by std::visit on a Body.

/// archive_job(spec, progress): loads the body's meshes, of which the job computes the archive. Throws
/// std::runtime_error on a bad mesh, the job on a bad body or too little memory.
using ArchiveJob = std::function<Archive()>;

/// make_haptic_part(spec, archive, settings): what the haptic step knows of the body; null for moving tissue, whose
/// state the deformation node owns. `archive` is read with ArchivePart::touchable.
std::unique_ptr<BodyPart> make_haptic_part(const MovingSpec& body, const Archive& archive,
                                           const StepSettings& settings);

/// make_shape(spec, archive): its visible surface as it follows from what the haptic node says of the body. `archive` is
/// read with ArchivePart::surface.
std::unique_ptr<BodyShape> make_shape(const MovingSpec& body, const Archive& archive);

/// make_organ(spec, archive, settings): the body as the deformation node advances it; null for a body that the haptic
/// step owns. Throws std::runtime_error naming the body if the scene's step is not stable.
std::unique_ptr<DynamicOrgan> make_organ(const NamedSpec& body, const Archive& archive, const StepSettings& settings);
std::unique_ptr<DynamicOrgan> make_organ(const MovingSpec& body, const Archive& archive, const StepSettings& settings);

/// made_archive(spec): the archive of a body without a mesh, for which there is no file; empty for all others.
std::optional<Archive> made_archive(const MeshedSpec& body);

}  // namespace palpate
