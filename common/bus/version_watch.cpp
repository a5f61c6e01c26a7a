#include "common/bus/version_watch.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include "common/bus/log_format.hpp"
#include "common/describe/printable.hpp"

namespace palpate {
namespace {

const char* const kProgram = "palpate";

std::string messages_hash() {
  const std::string schema = schema_text();
  return fmt::format("{:016x}", XXH3_64bits(schema.data(), schema.size()));
}

std::vector<std::string> split(const std::string& words) {
  std::vector<std::string> parts{""};
  for (const char c : words)
    if (c == ';')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// A part of a sentence that came from outside.
std::string part_of_sentence(const std::string& text) {
  return printable(text.substr(0, 80));
}

}  // namespace

std::string participant_words() {
  char host[256] = "localhost";
  gethostname(host, sizeof host - 1);
  return fmt::format("{};{};{};{}@{}", kProgram, PALPATE_VERSION, messages_hash(), getpid(), host);
}

std::string version_fault(const std::string& words) {
  const std::vector<std::string> parts = split(words);
  if (parts.size() != 4 || parts[0] != kProgram || parts[2] == messages_hash()) return {};
  return fmt::format(
      "cannot talk with process {}: its palpate {} has other messages (version {}) than this {} (version {}); install "
      "the same on both",
      part_of_sentence(parts[3]), part_of_sentence(parts[1]), part_of_sentence(parts[2]), PALPATE_VERSION,
      messages_hash());
}

VersionWatch::VersionWatch(dds_entity_t participant)
    : reader_(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr)) {}

VersionWatch::~VersionWatch() {
  dds_delete(reader_);
}

std::vector<std::string> VersionWatch::look() {
  std::vector<std::string> sentences;
  void* sample = nullptr;
  dds_sample_info_t info;
  while (dds_take(reader_, &sample, &info, 1, 1) > 0) {
    void* data = nullptr;
    std::size_t size = 0;
    if (info.valid_data && dds_qget_userdata(static_cast<dds_builtintopic_participant_t*>(sample)->qos, &data, &size) &&
        data) {
      const std::string sentence = version_fault({static_cast<const char*>(data), size});
      if (!sentence.empty() && said_.insert(sentence).second) sentences.push_back(sentence);
      dds_free(data);
    }
    dds_return_loan(reader_, &sample, 1);
    sample = nullptr;
  }
  return sentences;
}

}  // namespace palpate
