#pragma once
#include <string_view>

namespace palpate::web {

/// A file of the page, built in.
struct PageFile {
  std::string_view path;  ///< "/main.js"
  std::string_view type;  ///< "text/javascript"
  std::string_view text;
};

/// Null if there is none of that path.
const PageFile* find_page(std::string_view path);

}  // namespace palpate::web
