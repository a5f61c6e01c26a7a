#include "common/log/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace palpate {

void open_log(const std::string& program) {
  spdlog::set_default_logger(spdlog::stderr_color_mt(program));
  spdlog::set_pattern("%H:%M:%S.%e %n: %v");
}

void log_warnings_alone() {
  spdlog::set_level(spdlog::level::warn);
}

void log_info(std::string_view message) {
  spdlog::info(message);
}
void log_warning(std::string_view message) {
  spdlog::warn(message);
}

}  // namespace palpate
