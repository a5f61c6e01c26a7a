#pragma once
#include <string>

#include "common/describe/key_list.hpp"

namespace palpate {

/// The page with the table of keys below each heading "## `[[body]]` ..." as `keys` gives it; all else as it is. Throws
/// std::runtime_error if a table has no heading, or a heading no table.
std::string with_reference(const std::string& page, const KeyList& keys);

}  // namespace palpate
