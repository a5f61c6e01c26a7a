// Do the solid elements converge to published values and closed forms? Besides the rows on stdout, an output path as
// argument gets case,element,n,unknowns,value,target over all mesh sizes: scripts/verification.py makes
// docs/verification.md of it. In the profiles of point forces n counts the elements between the force and the place.
#include <fstream>
#include <functional>

#include "bench/half_space.hpp"
#include "bench/report.hpp"
#include "bench/solid_cases.hpp"
#include "bench/solid_patch.hpp"
#include "common/fem/processor_blas.hpp"

namespace palpate::bench {
namespace {

struct Published {
  std::string name;
  double target;
  std::function<SolidAnswer(int, const Offline&)> solve;
  std::vector<int> meshes;
};

std::vector<Published> published() {
  const auto cylinder = [](double nu) { return [nu](int n, const Offline& o) { return thick_cylinder(n, o, nu); }; };
  const auto straight = [](int axis) { return [axis](int n, const Offline& o) { return straight_beam(n, o, axis); }; };
  const auto curved = [](bool plane) { return [plane](int n, const Offline& o) { return curved_beam(n, o, plane); }; };
  return {{"straight_beam_extension", 3.0e-5, straight(0), {1, 2, 4}},
          {"straight_beam_in_plane", 0.1081, straight(1), {1, 2, 4}},
          {"straight_beam_out_of_plane", 0.4321, straight(2), {1, 2, 4}},
          {"straight_beam_twist", twist_target(), straight_beam_twist, {1, 2, 4}},
          {"curved_beam_in_plane", 0.08734, curved(true), {1, 2, 4}},
          {"curved_beam_out_of_plane", 0.5022, curved(false), {1, 2, 4}},
          {"cooks_membrane", 23.96, cooks_membrane, {4, 8, 16}},
          {"nafems_le10", -5.38e6, nafems_le10, {2, 4, 8}},
          {"thick_cylinder_049", thick_cylinder_target(0.49), cylinder(0.49), {4, 8, 16}},
          {"thick_cylinder_0499", thick_cylinder_target(0.499), cylinder(0.499), {4, 8, 16}},
          {"thick_cylinder_04999", thick_cylinder_target(0.4999), cylinder(0.4999), {4, 8, 16}}};
}

struct Element {
  const char* name;
  Offline offline;
};

const std::vector<Element> kElements{{"p1", {}},
                                     {"p1_refine1_locking_free", {1, FiniteElement::p1, Formulation::locking_free}},
                                     {"p2", {0, FiniteElement::p2, Formulation::displacement}},
                                     {"p2_locking_free", {0, FiniteElement::p2, Formulation::locking_free}}};

/// Rows of the table, and each error on stdout.
class Table {
 public:
  bool open(const char* path) { return file_.open(path), !file_.fail(); }
  void head() { file_ << "case,element,n,unknowns,value,target\n"; }
  void add(const std::string& name, const Element& element, int n, int unknowns, double value, double target) {
    file_ << fmt::format("{},{},{},{},{:.8g},{:.8g}\n", name, element.name, n, unknowns, value, target) << std::flush;
  }
  void compare(const std::string& name, const Element& element, int n, int unknowns, double value, double target) {
    add(name, element, n, unknowns, value, target);
    report("verification", name, fmt::format("{}_n{}", element.name, n), 100 * (value / target - 1), "%");
  }

 private:
  std::ofstream file_;
};

void published_values(Table& table, bool quick) {
  for (const auto& one : published())
    for (const auto& element : kElements)
      for (int n : one.meshes) {
        if (quick && n == one.meshes.back()) continue;
        const auto answer = one.solve(n, element.offline);
        table.compare(one.name, element, n, answer.unknowns, answer.value, one.target);
      }
}

/// Kelvin and Boussinesq halfway to the far faces, and on the finest mesh over the distance.
void point_forces(Table& table, const std::vector<int>& meshes) {
  for (const auto& [name, infinite] :
       {std::pair{std::string("kelvin"), true}, std::pair{std::string("boussinesq"), false}})
    for (const auto& element : kElements)
      for (int n : meshes) {
        const auto found = point_force(n, element.offline, 0.3, infinite);
        const int half = n / 2 - 1;
        table.compare(name + "_ahead", element, n, found.unknowns, found.ahead[half], found.exact_ahead[half]);
        table.compare(name + "_beside", element, n, found.unknowns, found.beside[half], found.exact_beside[half]);
        for (int k = 1; n == meshes.back() && k < n; ++k) {
          table.add(name + "_ahead_profile", element, k, found.unknowns, found.ahead[k - 1], found.exact_ahead[k - 1]);
          table.add(name + "_beside_profile", element, k, found.unknowns, found.beside[k - 1],
                    found.exact_beside[k - 1]);
        }
      }
}

void pressed_discs(Table& table, const std::vector<int>& meshes) {
  for (const auto& [name, poisson] : {std::pair{"disc_03", 0.3}, std::pair{"disc_04999", 0.4999}})
    for (const auto& element : kElements)
      for (int n : meshes) {
        const auto mesh = palpate::testing::make_jittered_block({1, 1, 1}, {n, n, n}, 0.2);
        const auto found = solve_disc(mesh, element.offline, poisson);
        table.compare(name, element, n, found.unknowns, found.value, pressed_disc_mean(poisson));
      }
}

/// Largest errors over three irregular cubes, in units of rounding; nothing to be compared with but zero.
void patches(Table& table) {
  for (const auto& [name, poisson] :
       {std::pair{std::string("patch_025"), 0.25}, std::pair{std::string("patch_04999"), 0.4999}})
    for (const auto& element : kElements) {
      PatchErrors worst{};
      for (unsigned seed : {1, 2, 3}) {
        const auto found = solid_patch(element.offline, poisson, seed);
        worst = {std::max(worst.displacement, found.displacement), std::max(worst.stress, found.stress),
                 found.unknowns};
      }
      table.add(name + "_displacement", element, 4, worst.unknowns, worst.displacement, 0);
      table.add(name + "_stress", element, 4, worst.unknowns, worst.stress, 0);
      report("verification", name, std::string(element.name) + "_displacement", worst.displacement, "rounding");
      report("verification", name, std::string(element.name) + "_stress", worst.stress, "rounding");
    }
}

int run(int argc, char** argv) {
  Table table;
  for (int i = 1; i < argc; ++i)
    if (argv[i][0] != '-' && !table.open(argv[i]))
      return fmt::print(stderr, "bench_verification: the table cannot be written\n"), 1;
  table.head();
  const bool few = quick(argc, argv);
  const std::vector<int> meshes = few ? std::vector{4, 8} : std::vector{4, 8, 16};
  patches(table);
  published_values(table, few);
  point_forces(table, meshes);
  pressed_discs(table, meshes);
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  palpate::use_blas_of_this_processor(argv);
  return palpate::bench::run(argc, argv);
}
