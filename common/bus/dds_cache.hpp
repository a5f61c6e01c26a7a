#pragma once
#include <dds/dds.h>

#include <functional>

namespace palpate {

/// A reader as dds_create_reader() makes it, but for keys that are disposed of without a message: these pass no topic
/// filter, and the middleware remembers each for as long as its writer lives. No node of this project sends them. They
/// are left out, as if they had been taken, and `refused` is called for each, on the middleware's threads.
dds_entity_t create_reader_of_messages(dds_entity_t participant, dds_entity_t topic, const dds_qos_t* qos,
                                       const dds_listener_t* listener, std::function<void()> refused);

}  // namespace palpate
