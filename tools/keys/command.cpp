#include <fmt/chrono.h>
#include <fmt/format.h>

#include <map>

#include "common/bus/roles.hpp"
#include "tools/keys/key_folder.hpp"
#include "tools/shared/commands.hpp"

namespace palpate {
namespace {

struct KeysOptions {
  std::string folder, role, name;
  int days = 730;
};

/// Who uses the keys of a role.
const std::map<std::string, std::string>& users() {
  static const std::map<std::string, std::string> programs{
      {"haptic", "haptic_node"},
      {"deform", "deform_node"},
      {"render", "render_node"},
      {"web", "web_node"},
      {"driver", "a program that moves a tool and feels its force"},
      {"recorder", "palpate record"},
      {"observer", "palpate top; reads all, writes nothing"},
      {"player", "palpate replay"},
      {"latency", "palpate latency"}};
  return programs;
}

std::string day_of(std::time_t time) {
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(time));
}

void print_all(const std::string& folder, std::time_t end) {
  fmt::print("{}: an authority and keys of {} roles, valid until {}\n", folder, bus_roles().size(), day_of(end));
  fmt::print(
      "authority/ stays here: with its key one can make keys for everything. Each other folder goes to the hosts that "
      "run\n");
  for (const std::string& role : bus_roles()) fmt::print("  {:10} {}\n", role + "/", users().at(role));
  fmt::print(
      "deploy.sh brings each host the keys of its nodes and no others. In the scene, the path being relative to it:\n"
      "  [network.security]\n"
      "  keys = \"{}\"\n",
      folder);
}

void run(const KeysOptions& o) {
  constexpr std::time_t day = 24 * 60 * 60;
  const std::time_t now = std::time(nullptr);
  // A host whose clock is behind by less than a day can use them at once.
  const keys::Period period{now - day, now + o.days * day};
  if (o.role.empty()) {
    keys::make_folder(o.folder, period);
    print_all(o.folder, period.to);
    return;
  }
  const std::string name = o.name.empty() ? o.role : o.name;
  const std::time_t end = keys::add_keys(o.folder, o.role, name, period);
  fmt::print("{}/{}: keys of the role {}, valid until {}, for a host that runs {}\n", o.folder, name, o.role,
             day_of(end), users().at(o.role));
}

}  // namespace

void add_keys_command(cli::Command& app) {
  auto o = std::make_shared<KeysOptions>();
  cli::Command command =
      app.add_command("keys", "Make the keys by which nodes know each other and encrypt what they send");
  command.add_option("FOLDER", o->folder, "Folder to make, with an authority and a folder for each role").required();
  command.add_option("--days", o->days, "How long the keys hold").between(1, 7300).show_default();
  const cli::Option add =
      command.add_option("--add", o->role, "Make further keys of this role from the authority that is there")
          .one_of(bus_roles());
  command.add_option("--name", o->name, "Their folder's name (default: the role)").needs(add);
  command.examples({"palpate keys out/keys --days 90", "palpate keys out/keys --add render --name projector"});
  command.does([o] { run(*o); });
}

}  // namespace palpate
