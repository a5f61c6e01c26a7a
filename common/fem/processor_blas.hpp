#pragma once

namespace palpate {

/// OpenBLAS takes a processor that is newer than itself for one of 2004, and only its environment, which it looks at
/// before main(), can tell it better. Where it did, starts the program anew with that word in the environment;
/// otherwise does nothing. To be called first in main().
void use_blas_of_this_processor(char** argv);

}  // namespace palpate
