// The same for what is compiled with less optimisation.
#pragma once
#include "cmake/precompiled_program.hpp"
