// How much of the memory's bandwidth does the superposition of 64 contacts on the liver's surface reach?
// Contact sets rotate through the whole compliance, which is larger than the second-level cache, and so do
// the buffers of the plain copy beside it.
#include <cstring>
#include <memory>
#include <new>
#include <random>

#include "bench/report.hpp"
#include "common/kernels/kernels.hpp"

namespace {
using namespace palpate;

/// Aligned like the compliance, every page touched.
template <class Scalar>
struct Columns {
  Columns(std::ptrdiff_t rows, int count)
      : stride((rows + 15) / 16 * 16), data(new (std::align_val_t(64)) Scalar[stride * count]) {
    for (std::ptrdiff_t i = 0; i < stride * count; ++i) data[i] = Scalar(1e-4) * static_cast<Scalar>(i % 1013);
  }
  ~Columns() { ::operator delete[](data, std::align_val_t(64)); }
  Columns(const Columns&) = delete;

  std::ptrdiff_t stride;
  Scalar* data;
};

void combine(const float* const* c, const float* w, int count, std::ptrdiff_t rows, float* out) {
  kernels::active().combine_f(c, w, count, rows, out);
}
void combine(const double* const* c, const double* w, int count, std::ptrdiff_t rows, double* out) {
  kernels::active().combine_d(c, w, count, rows, out);
}

/// Median time [s] of one superposition; set i takes the columns of `contacts` nodes drawn at random.
template <class Scalar>
double superpose(const Columns<Scalar>& compliance, std::ptrdiff_t rows, int contacts, int repeat) {
  std::mt19937 random(3);
  const int nodes = static_cast<int>(rows) / 3, sets = 64;
  std::vector<const Scalar*> columns;
  for (int set = 0; set < sets; ++set)
    for (int k = 0; k < contacts; ++k) {
      const int node = static_cast<int>(random() % nodes);
      for (int axis = 0; axis < 3; ++axis) columns.push_back(compliance.data + compliance.stride * (3 * node + axis));
    }
  std::vector<Scalar> force(3 * contacts, Scalar(0.5)), out(rows);
  bench::Samples samples;
  samples.measure(2 * sets, repeat, [&](int i) {
    const int set = (i + 2 * sets) % sets;
    combine(columns.data() + set * 3 * contacts, force.data(), 3 * contacts, rows, out.data());
    bench::keep(out[0]);
  });
  return samples.median();
}

/// Median time [s] of a plain copy of `bytes`, source and target walking through `arena`.
double copy(const char* arena, std::size_t arena_bytes, std::size_t bytes, int repeat) {
  const int places = static_cast<int>(arena_bytes / bytes);
  const std::unique_ptr<char[]> target(new char[places * bytes]());
  bench::Samples samples;
  samples.measure(2 * places, repeat, [&](int i) {
    const std::size_t at = static_cast<std::size_t>((i + 2 * places) % places) * bytes;
    std::memcpy(target.get() + at, arena + at, bytes);
    bench::keep(target[at]);
  });
  return samples.median();
}

template <class Scalar>
void compare(std::string_view name, std::ptrdiff_t rows, int contacts, int repeat) {
  const Columns<Scalar> compliance(rows, static_cast<int>(rows));
  const std::size_t bytes = sizeof(Scalar) * rows * 3 * contacts;
  const std::size_t arena = sizeof(Scalar) * compliance.stride * rows;
  const double time = superpose(compliance, rows, contacts, repeat);
  const double copied = copy(reinterpret_cast<const char*>(compliance.data), arena, bytes, repeat);
  const double rate = bytes / time, copy_rate = 2.0 * bytes / copied;
  bench::report("superpose", name, "p50", 1e6 * time, "us");
  bench::report("superpose", name, "bandwidth", 1e-9 * rate, "GB/s");
  bench::report("superpose", name, "copy_bandwidth", 1e-9 * copy_rate, "GB/s");
  bench::report("superpose", name, "bandwidth_ratio", rate / copy_rate, "1");
}

}  // namespace

int main(int argc, char** argv) {
  const int repeat = palpate::bench::quick(argc, argv) ? 2000 : 20000;
  compare<float>("liver1400_64", 1563, 64, repeat);
  compare<double>("liver1400_64_double", 1563, 64, repeat);
}
