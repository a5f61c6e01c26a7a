#pragma once
#include "tools/study/method.hpp"
#include "tools/study/solid_case.hpp"

namespace palpate::study {

/// Precomputed tensors held by the contact law of the haptic node: rule, number and precision of tensors,
/// offline discretisation, quasi non-linear correction.
std::unique_ptr<Method> make_quasi_static(std::shared_ptr<SolidCase> solid);

/// What being linear costs over depth: both solutions by the same solver on the same mesh. And how far the
/// fine linear reference itself may be trusted.
std::unique_ptr<Method> make_linearity(std::shared_ptr<SolidCase> solid);

}  // namespace palpate::study
