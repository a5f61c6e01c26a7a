#include <gtest/gtest.h>

#include <algorithm>

#include "common/models/check/check.hpp"
#include "common/models/quasi_static/spec.hpp"

namespace palpate {
namespace {

/// A cylinder held at its top whose lower end may have a modulus of its own, and what a check warns of.
std::vector<std::string> warnings_of(std::optional<double> lower_young, ContactRule rule) {
  QuasiStaticSpec body;
  body.name = "cylinder";
  body.mesh = PALPATE_SOURCE_DIR "/scenes/meshes/cylinder_hybrid.msh";
  body.material = {1500, 0.4, 1000};
  body.fixed.push_back({.where = {.indices = {}, .box = {}, .group = "top"}});
  if (lower_young)
    body.materials.push_back(
        {.where = {.indices = {}, .box = {}, .group = "lower"}, .material = {*lower_young, 0.4, 1000}});
  ContactSpec contact;
  contact.rule = rule;
  const std::vector<Tool> tools(1);
  CheckReport report;
  report.say = [](const std::string&) {};
  check(body, {contact, tools, {}, 1e-3, [](ArchivePart) { return std::optional<Archive>(); }, {}, {}}, report);
  return report.warnings;
}

bool tells_of_materials(const std::vector<std::string>& warnings) {
  return std::ranges::any_of(warnings, [](const std::string& w) {
    return w.find("is of other materials than its own: a patch feels the tissue next to it with 1500 Pa") !=
           std::string::npos;
  });
}

TEST(CheckQuasiStatic, WarnsOfOtherMaterialsUnderPatches) {
  EXPECT_TRUE(tells_of_materials(warnings_of(9000, ContactRule::patch)));
  EXPECT_FALSE(tells_of_materials(warnings_of(1500, ContactRule::patch)));
  EXPECT_FALSE(tells_of_materials(warnings_of({}, ContactRule::patch)));
  EXPECT_FALSE(tells_of_materials(warnings_of(9000, ContactRule::barycentric)));
}

TEST(CheckQuasiStatic, QuadraticElementsAreTheDefaultUnlessTheSurfaceIsFine) {
  QuasiStaticSpec body;
  EXPECT_EQ(offline_of(body, 3000).element, FiniteElement::p2);
  EXPECT_EQ(offline_of(body, 3001).element, FiniteElement::p1);
  EXPECT_EQ(why_offline(body, 3001), "the mesh has more than 3000 surface nodes");
  body.offline = Offline{.element = FiniteElement::p2};
  EXPECT_EQ(offline_of(body, 3001).element, FiniteElement::p2);
}

}  // namespace
}  // namespace palpate
