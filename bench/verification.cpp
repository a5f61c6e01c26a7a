// Do the solid elements converge to the published values? Besides the rows on stdout, an output path as argument gets
// case,element,n,unknowns,value,target over all mesh sizes: scripts/verification.py makes docs/verification.md of it.
#include <fstream>
#include <functional>

#include "bench/report.hpp"
#include "bench/solid_cases.hpp"

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
                                     {"p1_refine1_locking_free", {1, "p1", "locking_free"}},
                                     {"p2", {0, "p2", "displacement"}},
                                     {"p2_locking_free", {0, "p2", "locking_free"}}};

int run(int argc, char** argv) {
  std::ofstream table;
  for (int i = 1; i < argc; ++i)
    if (argv[i][0] != '-') table.open(argv[i]);
  if (table.fail()) return fmt::print(stderr, "bench_verification: the table cannot be written\n"), 1;
  table << "case,element,n,unknowns,value,target\n";
  for (const auto& one : published())
    for (const auto& element : kElements)
      for (int n : one.meshes) {
        if (quick(argc, argv) && n == one.meshes.back()) continue;
        const auto answer = one.solve(n, element.offline);
        table << fmt::format("{},{},{},{},{:.8g},{:.8g}\n", one.name, element.name, n, answer.unknowns, answer.value, one.target);
        table.flush();
        report("verification", one.name, fmt::format("{}_n{}", element.name, n), 100 * (answer.value / one.target - 1), "%");
      }
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  return palpate::bench::run(argc, argv);
}
