#pragma once

namespace palpate::stability {

/// Returns once every other thread of this process sleeps: what was asked of them has been answered. A row then does
/// not depend on how fast they are.
void wait_for_workers();

}  // namespace palpate::stability
