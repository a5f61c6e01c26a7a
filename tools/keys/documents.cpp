#include "tools/keys/documents.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace palpate::keys {
namespace {

const std::string kDomains = "<domains><id_range><min>0</min><max>230</max></id_range></domains>";

std::string document(const std::string& schema, const std::string& body) {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<dds xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\"\n"
      "     xsi:noNamespaceSchemaLocation=\"http://www.omg.org/spec/DDS-SECURITY/20170901/{}.xsd\">\n{}</dds>\n",
      schema, body);
}

/// An element that is left out where it would be empty.
std::string topic_list(const std::string& what, const std::vector<std::string>& topics) {
  if (topics.empty()) return {};
  std::string list;
  for (const std::string& topic : topics) list += fmt::format("        <topic>{}</topic>\n", topic);
  return fmt::format("      <{0}><topics>\n{1}      </topics></{0}>\n", what, list);
}

std::string date(std::time_t time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}Z", fmt::gmtime(time));
}

}  // namespace

std::string governance_document() {
  return document("omg_shared_ca_governance",
                  fmt::format("  <domain_access_rules><domain_rule>\n"
                              "    {}\n"
                              "    <allow_unauthenticated_participants>false</allow_unauthenticated_participants>\n"
                              "    <enable_join_access_control>true</enable_join_access_control>\n"
                              "    <discovery_protection_kind>ENCRYPT</discovery_protection_kind>\n"
                              "    <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>\n"
                              "    <rtps_protection_kind>NONE</rtps_protection_kind>\n"
                              "    <topic_access_rules><topic_rule>\n"
                              "      <topic_expression>*</topic_expression>\n"
                              "      <enable_discovery_protection>true</enable_discovery_protection>\n"
                              "      <enable_liveliness_protection>true</enable_liveliness_protection>\n"
                              "      <enable_read_access_control>true</enable_read_access_control>\n"
                              "      <enable_write_access_control>true</enable_write_access_control>\n"
                              "      <metadata_protection_kind>ENCRYPT</metadata_protection_kind>\n"
                              "      <data_protection_kind>ENCRYPT</data_protection_kind>\n"
                              "    </topic_rule></topic_access_rules>\n"
                              "  </domain_rule></domain_access_rules>\n",
                              kDomains));
}

std::string permissions_document(const std::string& role, const std::string& subject, const Rights& rights,
                                 const Period& period) {
  return document("omg_shared_ca_permissions",
                  fmt::format("  <permissions><grant name=\"{}\">\n"
                              "    <subject_name>{}</subject_name>\n"
                              "    <validity><not_before>{}</not_before><not_after>{}</not_after></validity>\n"
                              "    <allow_rule>\n"
                              "      {}\n"
                              "{}{}"
                              "    </allow_rule>\n"
                              "    <default>DENY</default>\n"
                              "  </grant></permissions>\n",
                              role, subject, date(period.from), date(period.to), kDomains,
                              topic_list("publish", rights.writes), topic_list("subscribe", rights.reads)));
}

}  // namespace palpate::keys
