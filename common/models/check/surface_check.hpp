#pragma once
#include <array>

#include "common/mesh/selector.hpp"
#include "common/models/check/check.hpp"

namespace palpate {

/// Which kind of selector it is: "group 'top'", "a box", "a list of nodes"; `list` names what a list holds.
std::string describe(const Selector& where, const char* list);

/// The axes that are held: "xz".
std::string letters(const std::array<bool, 3>& axes);

/// What a body takes whose shape follows from a compliance of its surface, computed by the classes that take it or by
/// their own formulas. `elements`: entries of the material field, 0 with one material; `fields`: what the deformation
/// node keeps of each surface node; `compressed`: bytes of compressed tensors, 0 where they are dense.
std::vector<MemoryPart> compliance_memory(const CheckSettings& settings, const SurfaceMap& surface,
                                          std::size_t elements, int fields, std::size_t compressed = 0);

/// One sentence for bodies without patches, where the rule asks for them.
void say_touched_by_mesh(const CheckSettings& settings, CheckReport& report);
/// For bodies with patches of tips and, where `shafts`, of shafts: which parts of tools press by them, and what the
/// others do.
void say_patches(const CheckSettings& settings, const std::string& body, bool shafts, CheckReport& report);
/// What `owner` computes for those patches when it starts; nothing where there are none.
void add_near_field(const char* owner, const CheckSettings& settings, const SurfaceMap& surface, bool shafts,
                    CheckReport& report);
/// [m] across: what an organ on a table has.
inline constexpr double kMaxBody = 1, kMinBody = 1e-3;

/// A tool smaller than the elements or larger than the body, a scale that is off. `body`: its name. `patches`: balls
/// press it by patches where the scene's rule says so, with a size of their own, not the mesh's.
std::vector<std::string> size_warnings(const CheckSettings& settings, const std::string& body,
                                       const SurfaceMap& surface, bool patches);

/// CheckReport::meets of a surface: `solid` bodies hold what is inside them, walls have a thickness [m].
std::function<bool(const Segment&, double)> meets_surface(const SurfaceMap& surface, bool solid, double thickness = 0);

}  // namespace palpate
