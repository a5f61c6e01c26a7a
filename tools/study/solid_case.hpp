#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include "common/fem/direct.hpp"
#include "common/fem/linear_contact.hpp"
#include "common/fem/refine_graded.hpp"
#include "tools/study/one_mesh.hpp"
#include "tools/study/press_errors.hpp"
#include "tools/study/reference_cache.hpp"

namespace palpate::study {

/// One solid body of a scene as all methods press it, and the references for those presses, computed when
/// first asked for.
class SolidCase {
 public:
  using Say = std::function<void(const std::string&)>;

  /// `whole`: the body on one mesh, as which it stands in scene() too.
  SolidCase(
      const Scene& scene, int body, OneMesh whole, bool quick, ReferenceCache cache = {},
      Say say = [](const std::string&) {});

  const Scene& scene() const { return scene_; }
  int index() const { return body_; }
  const Body& body() const { return scene_.bodies[body_]; }
  const SolidSpec& solid() const { return solid_; }
  bool has_two_meshes() const { return !second_mesh_.empty(); }  ///< in the scene's files
  bool quick() const { return quick_; }
  const TetMesh& mesh() const { return problem_.mesh; }
  const StaticProblem& problem() const { return problem_; }
  const SurfaceMap& surface() const { return surface_; }
  const PressErrors& errors() const { return errors_; }
  const Presses& presses() const { return errors_.presses(); }
  std::string name(const std::string& model) const;  ///< of a method: the model, with the body where there are several

  /// A scene of this body alone, as `from` has it, under a frictionless ball that comes to a patch along its
  /// press.
  Scene press_scene(const Scene& from, int patch) const;
  /// The path of the slide about the first patch. Throws std::runtime_error where the surface has no room for it.
  const SurfacePath& slide_path();
  /// [N] force of the converged solution at each of that path's places, pressed to a depth [m]: through presses a sixth
  /// of the radius apart; constant over the run-up.
  const std::vector<double>& slide_reference(double depth);

  /// Linear elasticity in quadratic elements on a mesh that is fine around each patch, which stands for the exact
  /// solution.
  const PressAnswer& fine_linear(int patch, int depth);
  /// [1] by how much fine_linear() differs from what meshes one level coarser give: an estimate of its own error (u,
  /// f).
  std::array<double, 2> fine_linear_rest();

  /// At the surface's nodes, of a field whose first nodes are the mesh's.
  std::vector<Eigen::Vector3d> at_surface(const std::vector<Eigen::Vector3d>& of_nodes) const;
  /// The body on a mesh that is fine under a ball at each place; `fineness` counts the nodes beyond the body's own.
  StaticProblem refined(std::span<const Patch> places, Fineness fineness, int& strides) const;
  double reach(double depth) const;  ///< [m] about a patch within which nodes may touch the ball

  /// The same contact with large strain and rotation (neo-Hookean), and with linear elasticity by the same
  /// solver, on one mesh; fewer depths where the solver gave up, with its reason, and none beyond the first
  /// two patches (quick: one).
  struct Nonlinearity {
    std::vector<PressAnswer> neo_hookean, linear;
    std::string gave_up;
    int nodes = 0, iterations = 0;
    double penetration = 0;  ///< [m] largest depth of a node in the ball
  };
  const Nonlinearity& nonlinearity(int patch);
  const std::vector<PressAnswer>& fine(int patch);
  PressAnswers neo_hookean();  ///< fine_linear() and what the law changes

  /// Adds the rows of a point against both references; see PressErrors::add().
  void add_errors(const Row& cost, const PressAnswers& presses, Result& result);

 private:
  std::vector<PressAnswer> press_fine(int patch, double coarser) const;
  std::vector<double> solve_fine(int patch, double coarser) const;
  std::vector<double> solve_slide(std::span<const Patch> places, double depth) const;
  std::vector<double> solve_nonlinear(int patch) const;
  std::span<const Patch> place(int patch) const { return std::span(presses().patches).subspan(patch, 1); }
  std::string key(std::span<const Patch> places, const Fineness& fineness) const;
  std::vector<PressAnswer> read_answers(const double*& at, std::size_t count) const;

  const std::string second_mesh_;  // content hash with it; empty unless a hybrid has one
  Scene scene_;
  const SolidSpec solid_;
  int body_;
  bool quick_;
  ReferenceCache cache_;
  Say say_;
  StaticProblem problem_;
  SurfaceMap surface_;
  PressErrors errors_;
  std::map<int, std::vector<PressAnswer>> fine_;
  std::map<int, Nonlinearity> nonlinearity_;
  std::optional<SurfacePath> slide_path_;
  std::map<double, std::vector<double>> slide_reference_;
};

}  // namespace palpate::study
