#pragma once
#include <filesystem>

namespace palpate::study {

/// Adds a line to machine.txt, for the page, unless it is there from today: processor, cores, how many settings are
/// settled at the same time, program version and date of figures that are taken from now on.
void describe_machine(const std::filesystem::path& folder, int jobs);

}  // namespace palpate::study
