#include "common/cli/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "common/cli/progress.hpp"
#include "common/describe/printable.hpp"
#include "common/files/file_kind.hpp"
#include "common/realtime/shutdown.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOutput = "FILE";  // shown in the help; marks what is written
constexpr const char* kForce = "--force";
const std::string kForceMeaning = "Write over files of another kind than what is written";
const std::string kKind = "kind";  // the check of an output that --force spares

/// Why a file is not written; empty: it may be.
std::string refuse_output(const std::string& name, const std::string& ending) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(name, error);
  if (fs::is_symlink(status)) return name + " is a link: name the file that is to be written itself";
  if (fs::is_directory(status)) return name + " is a folder, not a file that can be written";
  if (fs::exists(status) && !fs::is_regular_file(status))
    return name + " is no regular file, and would be replaced by one";
  if (!name.ends_with(ending)) return name + " does not end in " + ending;
  return "";
}

/// Why a file that is there is not replaced by one of these kinds; empty: it may be.
std::string refuse_kind(const std::string& name, const std::vector<std::string>& kinds) {
  std::error_code error;
  if (!fs::exists(name, error) || fs::file_size(name, error) == 0) return "";
  const std::string kind(kind_of(name));
  if (std::ranges::find(kinds, kind) != kinds.end()) return "";
  std::string written;
  for (const std::string& one : kinds)
    written += fmt::format("{}{}", written.empty() ? "" : " or ", kind_in_words(one));
  return fmt::format("{} is {}, and would be replaced by {}: give another name", name, kind_in_words(kind), written);
}

/// The first word that looks like an option and is none; empty: there is no such word.
std::string unknown_option(const CLI::App& app) {
  for (const std::string& word : app.remaining(true))
    if (word.starts_with('-')) return word;
  return "";
}

/// Says what was wrong, or the help that was asked for; the status is that of any other mistake, or 0.
int tell(const CLI::App& app, const CLI::ParseError& error) {
  return app.exit(error) == 0 ? 0 : 1;
}

/// Nothing of another kind is written over unless that is asked for, where --force asks for it.
void keep_other_kinds(const CLI::App& app) {
  const CLI::Option* const force = app.get_option_no_throw(kForce);
  const bool can_force = force && force->get_items_expected_max() == 0;
  if (!force || (can_force && force->count() > 0)) return;
  for (CLI::Option* output : const_cast<CLI::App&>(app).get_options()) {
    if (output->get_type_name() != kOutput) continue;
    CLI::Validator kind = *output->get_validator(kKind);
    kind.active();
    for (std::string name : output->results())
      if (const std::string why = kind(name); !why.empty())
        throw CLI::ValidationError(output->get_name(), can_force ? fmt::format("{}, or {}", why, kForce) : why);
  }
}

/// Of files that need not be there yet.
bool same_place(const std::string& a, const std::string& b) {
  std::error_code error;
  return fs::weakly_canonical(fs::absolute(a, error), error) == fs::weakly_canonical(fs::absolute(b, error), error);
}

/// For people, who may have gone: a pipe without a reader is no error of its own.
void tell_user(const std::string& sentence) {
  std::fputs(sentence.c_str(), stderr);
}

/// Whatever else is given on the command line is not written over.
void keep_inputs(const CLI::App& app) {
  for (const CLI::Option* output : app.get_options()) {
    if (output->get_type_name() != kOutput) continue;
    for (const std::string& to : output->results())
      for (const CLI::Option* other : app.get_options()) {
        if (other == output) continue;
        for (const std::string& from : other->results()) {
          std::error_code error;
          const bool both_written = other->get_type_name() == kOutput && same_place(from, to);
          if (both_written || fs::equivalent(from, to, error))
            throw CLI::ValidationError(output->get_name(), to + " is named by " + other->get_name() + " too");
        }
      }
  }
}

/// What needs a folder that is not there is told before the work whose result it is.
void ask_for_folders(const CLI::App& app) {
  for (const CLI::Option* output : app.get_options()) {
    if (output->get_type_name() != kOutput) continue;
    for (const std::string& name : output->results()) {
      if (name.empty()) continue;
      const fs::path folder = fs::absolute(name).parent_path();
      if (!fs::is_directory(folder))
        throw std::runtime_error(
            fmt::format("{}: it cannot be written, since the folder {} is not there", name, folder.string()));
    }
  }
}

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::positive() {
  const auto refuse = [](const std::string& text) {
    double number = 0;
    const bool good = CLI::detail::lexical_cast(text, number) && number > 0 && std::isfinite(number);
    return good ? std::string() : fmt::format("give a finite number above 0, not {}", text);
  };
  option_->check(refuse, "POSITIVE");
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

Option& Option::value_if_any(const std::string& without) {
  option_->expected(0, 1)->default_str(without);
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

Option& Option::output_file(const std::string& ending, const std::vector<std::string>& kinds) {
  const std::vector<std::string> written = kinds.empty() ? std::vector{ending} : kinds;
  option_->type_name(kOutput);
  option_->check([ending](const std::string& name) { return refuse_output(name, ending); }, "");
  option_->check(
      CLI::Validator([written](std::string& name) { return refuse_kind(name, written); }, "", kKind).active(false));
  if (!command_->get_option_no_throw(kForce)) command_->add_flag(kForce, kForceMeaning);
  return *this;
}

template <class T>
Option Command::add_option(const std::string& name, T& value, const std::string& meaning) {
  CLI::Option* const option = app_->add_option(name, value, meaning);
  if constexpr (requires { std::tuple_size<T>::value; }) option->delimiter(',');  // between spaces or commas
  return Option(option, app_);
}
template Option Command::add_option(const std::string&, std::string&, const std::string&);
template Option Command::add_option(const std::string&, int&, const std::string&);
template Option Command::add_option(const std::string&, double&, const std::string&);
template Option Command::add_option(const std::string&, std::filesystem::path&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Command::add_option(const std::string&, std::array<double, 3>&, const std::string&);
template Option Command::add_option(const std::string&, std::array<int, 3>&, const std::string&);

Option Command::add_flag(const std::string& name, bool& value, const std::string& meaning) {
  return Option(app_->add_flag(name, value, meaning), app_);
}

Command Command::add_command(const std::string& name, const std::string& meaning) {
  return Command(app_->add_subcommand(name, meaning));
}

void Command::may_be_quiet() {
  app_->add_flag_callback(
      "-q,--quiet", [] { set_telling(Telling::nothing); }, "Say nothing of how the work goes");
}

void Command::tells_progress() {
  may_be_quiet();
  app_->add_flag_callback(
          "-v,--verbose", [] { set_telling(Telling::everything); }, "Say more of how the work goes")
      ->excludes("--quiet");
}

bool Command::given(const std::string& name) const {
  return app_->count(name) > 0;
}

void Command::examples(std::initializer_list<std::string> lines) {
  app_->footer("Examples:\n  " + fmt::format("{}", fmt::join(lines, "\n  ")));
}

void Command::does(const std::function<void()>& work) {
  app_->callback([app = app_, work] {
    keep_inputs(*app);
    keep_other_kinds(*app);
    ask_for_folders(*app);
    work();
  });
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
  has_commands_ = true;
}

std::optional<int> CommandLine::read(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (has_commands_ && (words.empty() || words[0] == "help")) {  // "help NAME" is "NAME --help"
    words.erase(words.begin(), words.begin() + std::min<std::size_t>(words.size(), 1));
    words.push_back("--help");
  }
  const std::string name = std::filesystem::path(argv[0]).filename().string();
  const auto is_command = [&](const std::string& word) {
    return word.starts_with('-') || std::ranges::any_of(app_->get_subcommands({}),
                                                        [&](CLI::App* command) { return command->get_name() == word; });
  };
  if (has_commands_ && !is_command(words[0])) {
    tell_user(fmt::format("there is no command '{}'; `{} help` names all\n", words[0], name));
    return 1;
  }
  app_->name(name);
  std::ranges::reverse(words);  // as the package takes them
  try {
    app_->parse(std::move(words));
    keep_inputs(*app_);
    keep_other_kinds(*app_);
    ask_for_folders(*app_);
  } catch (const CLI::ParseError& error) {
    const auto kind = static_cast<CLI::ExitCodes>(error.get_exit_code());
    const bool may_be_unknown = kind == CLI::ExitCodes::RequiredError || kind == CLI::ExitCodes::ExtrasError;
    if (const std::string unknown = may_be_unknown ? unknown_option(*app_) : ""; !unknown.empty()) {
      tell_user(fmt::format("there is no option {}; --help names all\n", printable(unknown)));
      return 1;
    }
    return tell(*app_, error);
  }
  return std::nullopt;
}

int CommandLine::run(int argc, char** argv, const std::function<void()>& first) {
  try {
    if (first) first();
    if (const int status = read(argc, argv).value_or(0); status != 0) return status;
  } catch (const Interrupted& stop) {
    tell_user(fmt::format("palpate: {}\n", printable(stop.what())));
    return kInterruptedStatus;
  } catch (const std::exception& error) {
    tell_user(fmt::format("palpate: {}\n", printable(error.what())));
    return 1;
  }
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return 0;
  tell_user("palpate: not all that was to be printed could be written\n");
  return 1;
}

void require_output(const std::string& name, const std::string& ending, const std::vector<std::string>& kinds,
                    bool force) {
  std::string why = refuse_output(name, ending);
  if (why.empty() && !force) why = refuse_kind(name, kinds);
  if (!why.empty()) throw std::runtime_error(why);
}

}  // namespace palpate::cli
