#pragma once
#include <dds/dds.h>

#include <functional>
#include <string>

#include "common/bus/dds_bus.hpp"

namespace palpate {

/// Owns an entity of the C API and, through it, the entity's children.
class Entity {
 public:
  /// Throws std::runtime_error if `id` is an error: "network: WHAT failed: ...", with the middleware's last words.
  Entity(dds_entity_t id, const std::string& what);
  ~Entity() { dds_delete(id_); }
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  operator dds_entity_t() const { return id_; }

 private:
  dds_entity_t id_;
};

/// Keeps what the middleware says for the sentence of an exception; it prints nothing of its own. Call it before the
/// first entity is made.
void listen_to_middleware();

/// Hands the next sample that waits in a reader to `receive`, with the handle of its writer, and to `end` the keys of
/// streams without writers that it comes upon. False if there is none, or so many keys without a sample came first that
/// the caller is to come to its other work.
bool take_message(dds_entity_t reader, const std::function<void(const void*, dds_instance_handle_t)>& receive,
                  const std::function<void(const void*)>& end);

/// A participant of a domain that this process has joined, with the settings' keys if they name any. Throws
/// std::runtime_error in one sentence.
dds_entity_t make_participant(const BusSettings& settings);

}  // namespace palpate
