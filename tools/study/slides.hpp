#pragma once
#include "tools/rig/press_rig.hpp"
#include "tools/study/solid_case.hpp"

namespace palpate::study {

/// Leads the ball over the body as `scene` has it, without friction and with Coulomb's coefficient 0.3, and adds how
/// that feels and the course of its force; a note where the surface has no room for it. `of`: whose row it is.
/// `shares`: what press_around() gave, empty where it was not asked.
void add_slides(SolidCase& solid, const Scene& scene, const Archive& archive, const Row& of,
                const std::vector<double>& shares, Result& result);

/// Presses all over a patch's triangle to the deepest depth, with a ball that stands above the patch: forces as shares
/// of the reference's at the patch.
std::vector<double> press_around(SolidCase& solid, int patch, PressRig& rig);

}  // namespace palpate::study
