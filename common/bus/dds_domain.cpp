#include "common/bus/dds_domain.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "common/bus/dds_entity.hpp"
#include "common/realtime/settings.hpp"

namespace palpate {
namespace {

/// One per domain id and process.
struct Domain {
  std::string configuration;
  std::string keys, role;  ///< the middleware gives all participants of a process and domain the rights of the first
  Entity entity;
};

/// What dds_create_domain() returns. The middleware's threads have the nice value of who starts them.
dds_entity_t create_domain(const BusSettings& settings, const std::string& configuration) {
  dds_entity_t created = 0;
  std::thread([&] {
    if (settings.favoured) favour_thread();
    created = dds_create_domain(static_cast<dds_domainid_t>(settings.domain), configuration.c_str());
  }).join();
  return created;
}

}  // namespace

std::shared_ptr<const void> join_domain(const BusSettings& settings) {
  static std::mutex mutex;
  static std::map<int, std::weak_ptr<Domain>> domains;
  listen_to_middleware();
  const std::string configuration = dds_configuration(settings);
  const std::lock_guard lock(mutex);
  if (auto domain = domains[settings.domain].lock()) {
    if (domain->configuration == configuration && domain->keys == settings.keys &&
        (settings.keys.empty() || domain->role == settings.role))
      return domain;
    throw std::runtime_error(
        fmt::format("network: this process is already in domain {} with other settings", settings.domain));
  }
  auto domain = std::shared_ptr<Domain>(
      new Domain{configuration,
                 settings.keys,
                 settings.role,
                 {create_domain(settings, configuration), fmt::format("joining domain {}", settings.domain)}});
  domains[settings.domain] = domain;
  return domain;
}

}  // namespace palpate
