#pragma once
#include <filesystem>
#include <functional>
#include <string>

namespace palpate::study {

/// How a step's time grows over surface nodes, contacts, edges, modes and particles, on bodies made up for
/// it: writes growth.csv (what, unit, size, step_us_median, step_us_p99) into a folder.
void measure_growth(const std::filesystem::path& folder, bool quick,
                    const std::function<void(const std::string&)>& say);

}  // namespace palpate::study
