#pragma once
#include "tools/study/method.hpp"
#include "tools/study/solid_case.hpp"

namespace palpate::study {

/// Moving tissue of one model (tensor_mass | spring_mass | hybrid) pressed in the deformation node's organ:
/// integrator, step, precision, turning elements, resolution, share of a hybrid's dynamic elements; rest
/// after a cut. A body that has another model in its scene is neither cut nor refined, and in quick mode gets the model
/// alone, and turning elements.
std::unique_ptr<Method> make_dynamic(std::shared_ptr<SolidCase> solid, const std::string& model);

/// A body on a finer mesh of the same shape, everything that names its nodes and elements named anew.
struct FinerBody {
  Body body;
  TetMesh mesh;
};
FinerBody finer_body(const Body& body, const StaticProblem& problem, double share_of_edge);

/// The elements of a hybrid's tensor-mass part, grown by so many layers of neighbours; shrunk by as many if
/// negative.
std::vector<int> grown_part(const HybridSpec& body, const TetMesh& mesh, int layers);

}  // namespace palpate::study
