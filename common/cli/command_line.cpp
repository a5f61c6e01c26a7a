#include "common/cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>

namespace palpate::cli {

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::positive() {
  option_->check(CLI::PositiveNumber);
  return *this;
}

Option& Option::between(int low, int high) {
  option_->check(CLI::Range(low, high));
  return *this;
}

Option& Option::between(double low, double high) {
  option_->check(CLI::Range(low, high));
  return *this;
}

Option& Option::one_of(std::initializer_list<int> values) {
  option_->check(CLI::IsMember(std::vector<int>(values)));
  return *this;
}

Option& Option::one_of(const std::vector<std::string>& values) {
  option_->check(CLI::IsMember(values));
  return *this;
}

Option& Option::show_default() {
  option_->capture_default_str();
  return *this;
}

Option& Option::one_value_each_time() {
  option_->allow_extra_args(false);
  return *this;
}

Option& Option::excludes(const std::vector<std::string>& names) {
  for (const std::string& name : names) option_->excludes(name);
  return *this;
}

Option& Option::needs(const Option& other) {
  option_->needs(other.option_);
  return *this;
}

Option& Option::hidden() {
  option_->group("");
  return *this;
}

template <class T>
Option Command::add_option(const std::string& name, T& value, const std::string& meaning) {
  return Option(app_->add_option(name, value, meaning));
}
template Option Command::add_option(const std::string&, std::string&, const std::string&);
template Option Command::add_option(const std::string&, int&, const std::string&);
template Option Command::add_option(const std::string&, double&, const std::string&);
template Option Command::add_option(const std::string&, std::filesystem::path&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Command::add_option(const std::string&, std::array<double, 3>&, const std::string&);
template Option Command::add_option(const std::string&, std::array<int, 3>&, const std::string&);

Option Command::add_flag(const std::string& name, bool& value, const std::string& meaning) {
  return Option(app_->add_flag(name, value, meaning));
}

Command Command::add_command(const std::string& name, const std::string& meaning) {
  return Command(app_->add_subcommand(name, meaning));
}

void Command::does(const std::function<void()>& work) {
  app_->callback(work);
}

CommandLine::CommandLine(const std::string& meaning) : Command(nullptr), own_(std::make_unique<CLI::App>(meaning)) {
  app_ = own_.get();
}

CommandLine::~CommandLine() = default;

void CommandLine::show_version(const std::string& version) {
  app_->set_version_flag("--version", version);
}

void CommandLine::require_command() {
  app_->require_subcommand(1);
}

std::optional<int> CommandLine::read(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app_->exit(error);
  }
  return std::nullopt;
}

}  // namespace palpate::cli
