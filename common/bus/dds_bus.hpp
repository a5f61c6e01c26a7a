#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"

namespace palpate {

/// How a node joins the network. Without an interface it stays on this host (loopback).
struct BusSettings {
  int domain = 0;                    ///< 0..230; nodes of one simulation share it
  std::string interface {};          ///< name or address of a network interface; empty: loopback
  std::vector<std::string> peers{};  ///< hosts to ask; with any given, multicast is not used
  int lease_ms = 200;                ///< a writer that is silent for so long is dead for its readers
  std::filesystem::path keys{};  ///< folder of keys, see security.hpp; empty: open to all, and nothing of it is loaded
  std::string role{};            ///< whose keys of those: a role of roles.hpp; means nothing without keys
  bool favoured = false;         ///< what it receives comes before all that is not realtime on this host
  bool newest_alone = false;     ///< where it does not keep up, what comes is lost rather than late, as for pictures
  bool gathers = false;          ///< Writer::gather() waits for send(); else it is write()
};

/// The middleware's configuration for these settings, as XML text. Loopback: no multicast, large datagrams.
/// Network: datagrams that fit an Ethernet frame, because a lost fragment of a large one stalls the
/// receiver's kernel. Throws std::runtime_error in one sentence for a bad domain, interface or peer name.
std::string dds_configuration(const BusSettings& settings);

/// Where these settings meet others, in words: domain, interface and address, first UDP port, who is asked for others,
/// and keys.
std::string dds_place(const BusSettings& settings);

/// Joins the network. Several buses of one process may share a domain if their settings are the same.
/// Throws std::runtime_error in one sentence.
std::unique_ptr<Bus> make_dds_bus(const BusSettings& settings);

}  // namespace palpate
