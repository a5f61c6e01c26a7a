#include <dlfcn.h>

#include <stdexcept>

#include "tests/network/security/secured_test.hpp"

namespace palpate::testing {

namespace fs = std::filesystem;

OwnMiddleware::OwnMiddleware(const fs::path& folder) : folder_(folder) {
  Dl_info info{};
  if (dladdr(dlsym(RTLD_DEFAULT, "dds_create_participant"), &info) == 0) throw std::runtime_error("where is libddsc?");
  library_ = fs::canonical(info.dli_fname);
  fs::create_directories(folder_);
  fs::copy_file(library_, folder_ / fs::path(info.dli_fname).filename());
}

void OwnMiddleware::add_lenient_plugins() const {
  const fs::path from = library_.parent_path() / "libddsc0debian", to = folder_ / "libddsc0debian";
  fs::create_directories(to);
  for (const char* name : {"libdds_security_auth.so", "libdds_security_crypto.so"})
    fs::copy_file(from / name, to / name);
  fs::copy_file(program("lenient_access.so"), to / "libdds_security_ac.so");
}

std::string OwnMiddleware::environment() const {
  return fmt::format("LD_LIBRARY_PATH={} PALPATE_REAL_ACCESS={}", folder_.string(),
                     (library_.parent_path() / "libddsc0debian/libdds_security_ac.so").string());
}

}  // namespace palpate::testing
