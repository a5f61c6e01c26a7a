#pragma once

namespace palpate {

/// What the times of a trajectory's rows in a file are held to.
inline constexpr double kLatestRow = 1e6;   ///< [s] either way
inline constexpr double kRowsApart = 1e-6;  ///< [s] at least

}  // namespace palpate
