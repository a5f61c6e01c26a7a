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

/// OpenBLAS maps 128 MB to work in when it is first asked for a product. Where memory is locked that takes up to 0.1 s,
/// in which every other thread waits that maps memory itself. Has it done: to be called before a loop begins beside
/// which something is factorised.
void map_blas_memory();

}  // namespace palpate
