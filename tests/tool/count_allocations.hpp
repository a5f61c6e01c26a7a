#pragma once

namespace palpate {

/// How often this thread has called operator new in this program.
long allocations();

}  // namespace palpate
