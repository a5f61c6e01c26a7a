#include "common/bus/dds_entity.hpp"

#include <fmt/format.h>

#include <deque>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "common/bus/security.hpp"
#include "common/bus/version_watch.hpp"

namespace palpate {
namespace {

constexpr int kKeysAlone = 64;  // at once, without a message

/// The middleware's last words.
class LastWords {
 public:
  static LastWords& instance() {
    static auto* words = new LastWords;  // outlives the middleware's threads
    return *words;
  }
  std::string last() {
    const std::lock_guard lock(mutex_);
    return words_.empty() ? std::string() : words_.back();
  }
  void forget() {
    const std::lock_guard lock(mutex_);
    words_.clear();
  }
  std::vector<std::string> all() {
    const std::lock_guard lock(mutex_);
    return {words_.begin(), words_.end()};
  }

 private:
  LastWords() { dds_set_log_sink(&LastWords::sink, this); }
  static void sink(void* self, const dds_log_data_t* data) {
    auto& words = static_cast<LastWords*>(self)->words_;
    const std::lock_guard lock(static_cast<LastWords*>(self)->mutex_);
    if (words.size() == 32) words.pop_front();
    std::string& text = words.emplace_back(data->message, data->size);
    while (!text.empty() && text.back() == '\n') text.pop_back();
  }
  std::mutex mutex_;
  std::deque<std::string> words_;
};

}  // namespace

void listen_to_middleware() {
  LastWords::instance();
}

Entity::Entity(dds_entity_t id, const std::string& what) : id_(id) {
  if (id_ >= 0) return;
  if (id_ == DDS_RETCODE_NOT_ALLOWED_BY_SECURITY)
    throw std::runtime_error(fmt::format("network: {} is not permitted to the role of these keys", what));
  const std::string words = LastWords::instance().last();
  throw std::runtime_error(
      fmt::format("network: {} failed: {}{}{}", what, dds_strretcode(-id_), words.empty() ? "" : ", ", words));
}

bool take_message(dds_entity_t reader, const std::function<void(const void*, dds_instance_handle_t)>& receive,
                  const std::function<void(const void*)>& end) {
  for (int keys = 0; keys < kKeysAlone; ++keys) {
    void* sample = nullptr;
    dds_sample_info_t info;
    if (dds_take(reader, &sample, &info, 1, 1) <= 0) return false;
    const bool is_message = info.valid_data;
    if (is_message) receive(sample, info.publication_handle);
    if (info.instance_state == DDS_NOT_ALIVE_NO_WRITERS_INSTANCE_STATE) end(sample);
    dds_return_loan(reader, &sample, 1);
    if (is_message) return true;
  }
  return false;
}

dds_entity_t make_participant(const BusSettings& settings) {
  const auto id = static_cast<dds_domainid_t>(settings.domain);
  const std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)> qos(dds_create_qos(), &dds_delete_qos);
  const std::string words = participant_words();
  dds_qset_userdata(qos.get(), words.data(), words.size());
  if (settings.keys.empty()) return dds_create_participant(id, qos.get(), nullptr);
  const KeyFiles keys = find_keys(settings.keys, settings.role);
  for (const auto& [name, value] : security_properties(keys)) dds_qset_prop(qos.get(), name.c_str(), value.c_str());
  LastWords::instance().forget();
  const dds_entity_t participant = dds_create_participant(id, qos.get(), nullptr);
  if (participant < 0) throw std::runtime_error(why_refused(keys, LastWords::instance().all()));
  return participant;
}

}  // namespace palpate
