#pragma once
#include "idl/topics.hpp"

namespace palpate {

/// The topic of a message that is of one topic only.
template <class M>
constexpr const Topic<M>& topic_of() {
  return std::get<Topic<M>>(topics::all);
}

}  // namespace palpate
