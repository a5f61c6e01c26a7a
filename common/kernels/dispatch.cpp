#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "common/kernels/kernels.hpp"
#include "common/kernels/level.hpp"

namespace palpate::kernels {
namespace {

#define PALPATE_TABLE(name, level)                                                                                   \
  Table {                                                                                                            \
    name, level::combine_f, level::combine_d, level::combine_nodes_d, level::cholesky, level::cholesky_solve,        \
        level::cholesky_append, level::cholesky_remove, level::rk4_first_f, level::rk4_first_d, level::rk4_second_f, \
        level::rk4_second_d, level::semi_implicit_f, level::semi_implicit_d, level::forward_euler_f,                 \
        level::forward_euler_d, level::patch_rk4_first_f, level::patch_rk4_first_d, level::patch_rk4_second_f,       \
        level::patch_rk4_second_d, level::patch_semi_implicit_f, level::patch_semi_implicit_d,                       \
        level::patch_forward_euler_f, level::patch_forward_euler_d, level::springs_f, level::springs_d,              \
        level::corotated_f, level::corotated_d, level::kernel_moments                                                \
  }

constexpr Table kBase = PALPATE_TABLE("x86-64", base);
constexpr Table kV3 = PALPATE_TABLE("x86-64-v3", v3);
constexpr Table kV4 = PALPATE_TABLE("x86-64-v4", v4);

const Table& find(std::string_view name) {
  std::string known;
  for (const Table* table : available()) {
    if (table->name == name) return *table;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", table->name);
  }
  throw std::runtime_error(fmt::format("no kernels '{}' on this processor, which has {}", name, known));
}

const Table* choose() {
  const char* name = std::getenv("PALPATE_KERNELS");
  return name && *name ? &find(name) : available().back();
}

const Table*& chosen() {
  static const Table* table = choose();
  return table;
}

}  // namespace

std::vector<const Table*> available() {
  __builtin_cpu_init();
  std::vector<const Table*> tables{&kBase};
  if (__builtin_cpu_supports("x86-64-v3")) tables.push_back(&kV3);
  if (__builtin_cpu_supports("x86-64-v4")) tables.push_back(&kV4);
  return tables;
}

const Table& active() {
  return *chosen();
}

void use(std::string_view name) {
  const Table& table = find(name);
  chosen() = &table;
}

}  // namespace palpate::kernels
