#pragma once
#include <string>
#include <string_view>

namespace palpate {

/// Names the program in front of its messages, which go to standard error with the time. Call once, before the others.
void open_log(const std::string& program);

/// From here on no more than warnings.
void log_warnings_alone();

/// What a user may want to know of a run, and what he has to. From any thread, but not from a loop on time: they write.
void log_info(std::string_view message);
void log_warning(std::string_view message);

}  // namespace palpate
