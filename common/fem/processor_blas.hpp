#pragma once

namespace palpate {

/// OpenBLAS takes a processor that is newer than itself for one of 2004, and only its environment, which it looks at
/// before main(), can tell it better. Where it did, starts the program anew with that word in the environment;
/// otherwise does nothing. To be called first in main().
void use_blas_of_this_processor(char** argv);

/// OpenBLAS starts a thread for each core before main(), with a stack and 32 MB of room, which a program that locks its
/// memory keeps resident. Starts the program anew with one thread, unless the environment names a number. To be called
/// first in main().
void use_one_blas_thread(char** argv);

}  // namespace palpate
