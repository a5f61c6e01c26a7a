#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/organ/distance_grid.hpp"

namespace palpate {

/// What a command tells: lines, printed as it goes on, or at its end one line of JSON with the same figures.
class Output {
 public:
  using Json = nlohmann::ordered_json;
  explicit Output(bool json) : json_(json) {}

  /// A line of the text; names in it may be a file's. Its figures are added beside it.
  void say(const std::string& line) const;
  void warn(const std::string& sentence);
  /// Of the whole command; SI units in the keys.
  Json& figures() { return figures_; }
  /// Of the mesh that is being made.
  Json& mesh() { return figures_["meshes"].back(); }
  void next_mesh() { figures_["meshes"].push_back(Json::object()); }
  /// Prints the JSON where it is asked for.
  void finish() const;

 private:
  bool json_;
  Json figures_;
  std::vector<std::string> warnings_;
};

/// An image and its size, told and noted.
void tell_image(const std::string& file, const GridShape& shape, Output& out);

}  // namespace palpate
