#include "common/fem/processor_blas.hpp"

#include <cblas.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace palpate {
namespace {

constexpr const char* kCore = "OPENBLAS_CORETYPE";
constexpr const char* kThreads = "OPENBLAS_NUM_THREADS";

/// The newest kind of core that OpenBLAS 0.3.21 has code for and this processor can do; null: one that it knows.
const char* core_type() {
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl"))
    return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
  return nullptr;
}

/// Does not return, or changes nothing.
void start_anew(char** argv, const char* word, const char* value) {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return;
  setenv(word, value, 1);
  execv(program.c_str(), argv);
  unsetenv(word);
}

}  // namespace

void use_blas_of_this_processor(char** argv) {
  const char* const core = core_type();
  if (std::getenv(kCore) || !core || std::string_view(openblas_get_corename()) != "Prescott") return;
  start_anew(argv, kCore, core);
}

void use_one_blas_thread(char** argv) {
  if (!std::getenv(kThreads)) start_anew(argv, kThreads, "1");
}

}  // namespace palpate
