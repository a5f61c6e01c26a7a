#pragma once

namespace palpate {

/// A hand that has let go is given nothing any more, and one that is back gets its force by and by.
inline constexpr double kFadeSeconds = 0.02, kReturnSeconds = 0.05;  ///< [s] from all to nothing, and back

}  // namespace palpate
