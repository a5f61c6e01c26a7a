#pragma once
#include <string>
#include <utility>

namespace palpate {

/// The code path of a realtime step, as logs name it: "x86-64-v4; palpate 0.1.0 g++ 12.2.0". Two runs with the same
/// code path give the same bits for the same inputs.
std::string code_path();
/// Software part of this program's code path.
std::string this_software();
/// Vector width and software of a recorded code path.
std::pair<std::string, std::string> split_code_path(const std::string& recorded);

}  // namespace palpate
