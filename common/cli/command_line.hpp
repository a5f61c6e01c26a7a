#pragma once
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// The command line. Behind plain types, because the package that reads it takes seconds to compile.
namespace palpate::cli {

/// What more is asked of an option.
class Option {
 public:
  Option(CLI::Option* option, CLI::App* command) : option_(option), command_(command) {}

  Option& required();
  Option& positive();
  Option& between(int low, int high);
  Option& between(double low, double high);
  Option& one_of(std::initializer_list<int> values);
  Option& one_of(const std::vector<std::string>& values);
  Option& show_default();
  Option& value_if_any(const std::string& without);  ///< its name may stand alone, for this value
  Option& one_value_each_time();                     ///< of a list: each value has the option's name before it
  Option& excludes(const std::vector<std::string>& names);
  Option& needs(const Option& other);
  Option& hidden();
  /// It names a file that is written: refused where that is there and no regular file, is a link, is what another
  /// option of the command names, lies in a folder that is not there, or ends in another way than `ending` (".png")
  /// says; and, without the command's flag
  /// --force, which this adds, where it is of another kind (common/files/file_kind.hpp) than those that this option
  /// writes, `kinds` or that of `ending`. An empty file is of every kind.
  Option& output_file(const std::string& ending = "", const std::vector<std::string>& kinds = {});

 private:
  CLI::Option* option_;
  CLI::App* command_;
};

/// A command with its options; a handle.
class Command {
 public:
  explicit Command(CLI::App* app) : app_(app) {}

  /// `name`: "--name", "-n,--name", or "name" for one told by its place. `value` is written when the command line is
  /// read, and holds the default. For std::string, int, double, std::filesystem::path, std::vector<std::string>,
  /// std::array<double, 3> and std::array<int, 3>.
  template <class T>
  Option add_option(const std::string& name, T& value, const std::string& meaning);
  Option add_flag(const std::string& name, bool& value, const std::string& meaning = "");
  Command add_command(const std::string& name, const std::string& meaning);
  void may_be_quiet();    ///< -q says no more than results, warnings and faults (common/cli/progress.hpp)
  void tells_progress();  ///< -v says more as well
  bool given(const std::string& name) const;                ///< whether the command line, once read, has this option
  void examples(std::initializer_list<std::string> lines);  ///< command lines, at the end of its help
  /// What it does; run while the command line is read.
  void does(const std::function<void()>& work);

 protected:
  CLI::App* app_;
};

/// The command line of a program.
class CommandLine : public Command {
 public:
  explicit CommandLine(const std::string& meaning);
  ~CommandLine();

  void show_version(const std::string& version);  ///< with --version
  /// One of those added is asked for; without one, or after "help", the help is printed.
  void require_command();
  /// The status with which the program shall end now: after --help, or a mistake, which is said on standard error.
  /// What a command throws passes through.
  std::optional<int> read(int argc, char** argv);
  /// What main() shall return: does `first`, reads the command line, and says on standard error what these throw, or
  /// that not all could be printed.
  int run(int argc, char** argv, const std::function<void()>& first = {});

 private:
  std::unique_ptr<CLI::App> own_;
  bool has_commands_ = false;
};

/// Of a file whose name follows from an output's: throws std::runtime_error in one sentence where it is none that can
/// be written, or of another kind (file_kind.hpp) than `kinds` and `force` is not given.
void require_output(const std::string& name, const std::string& ending, const std::vector<std::string>& kinds,
                    bool force);

}  // namespace palpate::cli
