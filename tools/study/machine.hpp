#pragma once
#include <filesystem>

namespace palpate::study {

/// Adds a line to machine.txt, for the page: processor, cores, program version and date of figures that are taken from
/// now on.
void describe_machine(const std::filesystem::path& folder);

}  // namespace palpate::study
