#pragma once
#include <filesystem>
#include <string>

namespace palpate::study {

/// Makes plots and the page of a folder with scripts/study_page.py; says in one sentence what is missing
/// where it cannot, else an empty string.
std::string make_page(const std::filesystem::path& folder);

/// machine.txt: processor, cores, program version and date, for the page.
void describe_machine(const std::filesystem::path& folder);

}  // namespace palpate::study
