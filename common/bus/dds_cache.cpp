#include "common/bus/dds_cache.hpp"

#include <dds/ddsc/dds_rhc.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/q_protocol.h>

#include <utility>

// The middleware exports it and has no header for it.
extern "C" dds_rhc* dds_rhc_default_new(dds_reader* reader, const ddsi_sertype* type);

namespace palpate {
namespace {

/// Stands before the middleware's own cache of a reader, which is made with it.
struct Cache : dds_rhc {
  dds_rhc* inner = nullptr;
  std::function<void()> refused;
};

Cache& cache(dds_rhc* self) {
  return *static_cast<Cache*>(self);
}
Cache& cache(ddsi_rhc* self) {
  return cache(reinterpret_cast<dds_rhc*>(self));  // its first member
}

/// Hands a call on to the inner cache.
template <auto op>
struct Forward;
template <class R, class... A, R (*dds_rhc_ops::*op)(dds_rhc*, A...)>
struct Forward<op> {
  static R call(dds_rhc* self, A... rest) {
    dds_rhc* const inner = cache(self).inner;
    return (inner->common.ops->*op)(inner, rest...);
  }
};
template <class R, class... A, R (*ddsi_rhc_ops::*op)(ddsi_rhc*, A...)>
struct Forward<op> {
  static R call(ddsi_rhc* self, A... rest) {
    dds_rhc* const inner = cache(self).inner;
    return (inner->common.ops->rhc_ops.*op)(&inner->common.rhc, rest...);
  }
};

dds_return_t associate(dds_rhc* self, dds_reader* reader, const ddsi_sertype* type, ddsi_tkmap* keys) {
  dds_rhc*& inner = cache(self).inner;
  inner = dds_rhc_default_new(reader, type);
  return dds_rhc_associate(inner, reader, type, keys);
}

bool store(ddsi_rhc* self, const ddsi_writer_info* writer, ddsi_serdata* sample, ddsi_tkmap_instance* key) {
  Cache& c = cache(self);
  if (sample->kind == SDK_DATA || (sample->statusinfo & NN_STATUSINFO_DISPOSE) == 0)
    return dds_rhc_store(c.inner, writer, sample, key);
  c.refused();
  return true;
}

void free_both(ddsi_rhc* self) {
  dds_rhc_free(cache(self).inner);
  delete &cache(self);
}

constexpr dds_rhc_ops kOps{
    .rhc_ops = {.store = store,
                .unregister_wr = Forward<&ddsi_rhc_ops::unregister_wr>::call,
                .relinquish_ownership = Forward<&ddsi_rhc_ops::relinquish_ownership>::call,
                .set_qos = Forward<&ddsi_rhc_ops::set_qos>::call,
                .free = free_both},
    .read = Forward<&dds_rhc_ops::read>::call,
    .take = Forward<&dds_rhc_ops::take>::call,
    .readcdr = Forward<&dds_rhc_ops::readcdr>::call,
    .takecdr = Forward<&dds_rhc_ops::takecdr>::call,
    .add_readcondition = Forward<&dds_rhc_ops::add_readcondition>::call,
    .remove_readcondition = Forward<&dds_rhc_ops::remove_readcondition>::call,
    .lock_samples = Forward<&dds_rhc_ops::lock_samples>::call,
    .associate = associate,
};

}  // namespace

dds_entity_t create_reader_of_messages(dds_entity_t participant, dds_entity_t topic, const dds_qos_t* qos,
                                       const dds_listener_t* listener, std::function<void()> refused) {
  auto* const made = new Cache;  // the reader's, which frees it
  made->common.ops = &kOps;
  made->refused = std::move(refused);
  const dds_entity_t reader = dds_create_reader_rhc(participant, topic, qos, listener, made);
  if (reader < 0) delete made;
  return reader;
}

}  // namespace palpate
