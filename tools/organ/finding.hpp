#pragma once
#include <Eigen/Core>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/organ/output.hpp"

namespace palpate {

/// Something of one kind that is wrong with a file, each place of it, and what is done about it.
struct Finding {
  std::string what;                     ///< "3 triangles that are there twice", "a hole of 2 mm across with 4 edges"
  std::string done;                     ///< "left out"; empty: nothing
  std::vector<Eigen::Vector3d> places;  ///< [m]; empty: it has none
  std::string kind = {};                ///< "holes": of those of one kind the first is told, and how many there are
};

/// "(1.5, -20, 3) mm" of a place in metres.
std::string place_in_mm(const Eigen::Vector3d& x);

/// "3 triangles that are there twice, the first at (1, 2, 3) mm: left out"
std::string say(const Finding& finding);

/// Tells a line for each kind, and writes all places to `report` where that has a name: CSV of
/// found,done,x_mm,y_mm,z_mm. Throws std::runtime_error where the file cannot be written.
void tell_findings(const std::vector<Finding>& findings, const std::string& report, Output& out);

/// Does what finds something, and tells it, where that ends in a refusal too.
template <class Tell, class Work>
void tell_refused_too(const Tell& tell, const Work& work) {
  try {
    work();
  } catch (const std::runtime_error&) {
    tell();
    throw;
  }
  tell();
}

/// Says of which file an error is.
template <class Work>
auto of_file(const std::string& file, const Work& work) try {
  return work();
} catch (const std::runtime_error& error) {
  throw std::runtime_error(file + ": " + error.what());
}

}  // namespace palpate
