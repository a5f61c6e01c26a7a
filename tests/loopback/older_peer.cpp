/// A program of an earlier version: its ForceState and ToolState lack what came later. Usage: older_peer DOMAIN SECONDS
/// Writes tool states at 100 Hz on loopback and prints how many readers they found and how many force states came.
#include <dds/dds.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "older.h"

int main(int count, char** words) {
  if (count != 3) return 2;
  const auto domain = static_cast<dds_domainid_t>(std::atoi(words[1]));
  const std::string network =
      "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface address=\"127.0.0.1\" "
      "multicast=\"false\"/></Interfaces>"
      "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</"
      "ParticipantIndex><Peers><Peer "
      "address=\"127.0.0.1\"/></Peers><MaxAutoParticipantIndex>60</MaxAutoParticipantIndex></Discovery></Domain></"
      "CycloneDDS>";
  dds_create_domain(domain, network.c_str());
  const std::string own = "palpate;0.0.9;0123456789abcdef;" + std::to_string(getpid()) + "@earlier";
  dds_qos_t* about = dds_create_qos();
  dds_qset_userdata(about, own.data(), own.size());
  const dds_entity_t participant = dds_create_participant(domain, about, nullptr);
  dds_delete_qos(about);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, 0);
  const dds_entity_t tool =
      dds_create_topic(participant, &palpate_ToolState_desc, "palpate/tool_state", nullptr, nullptr);
  const dds_entity_t force =
      dds_create_topic(participant, &palpate_ForceState_desc, "palpate/force_state", nullptr, nullptr);
  const dds_entity_t writer = dds_create_writer(participant, tool, qos, nullptr);
  const dds_entity_t reader = dds_create_reader(participant, force, qos, nullptr);
  dds_delete_qos(qos);

  unsigned found = 0, came = 0;
  for (int i = 0; i < 100 * std::atoi(words[2]); ++i) {
    palpate_ToolState state{.tool = 0, .run = 7, .seq = static_cast<unsigned long long>(i + 1), .depth = 0.2};
    dds_write(writer, &state);
    dds_publication_matched_status_t matched{};
    dds_get_publication_matched_status(writer, &matched);
    found = matched.total_count > found ? matched.total_count : found;
    void* sample = nullptr;
    dds_sample_info_t info;
    while (dds_take(reader, &sample, &info, 1, 1) > 0) {
      came += info.valid_data;
      dds_return_loan(reader, &sample, 1);
      sample = nullptr;
    }
    usleep(10000);
  }
  std::printf("readers %u, forces %u\n", found, came);
  dds_delete(participant);
}
