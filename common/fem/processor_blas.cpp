#include "common/fem/processor_blas.hpp"

#include <cblas.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace palpate {
namespace {

constexpr const char* kWord = "OPENBLAS_CORETYPE";

/// The newest kind of core that OpenBLAS 0.3.21 has code for and this processor can do; null: one that it knows.
const char* core_type() {
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl"))
    return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
  return nullptr;
}

}  // namespace

void use_blas_of_this_processor(char** argv) {
  const char* const core = core_type();
  if (std::getenv(kWord) || !core || std::string_view(openblas_get_corename()) != "Prescott") return;
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return;
  setenv(kWord, core, 1);
  execv(program.c_str(), argv);
  unsetenv(kWord);  // as it is, then
}

}  // namespace palpate
