#include "common/log/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace palpate {

void open_log(const std::string& program) {
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
  sink->set_color(spdlog::level::info, "");
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(program, std::move(sink)));
  spdlog::set_pattern("%H:%M:%S.%e %n: %^%v%$");  // warnings in colour, on a terminal
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
