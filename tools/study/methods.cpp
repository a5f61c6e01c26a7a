#include <fmt/format.h>

#include "tools/study/catheter.hpp"
#include "tools/study/kinds.hpp"
#include "tools/study/modal.hpp"
#include "tools/study/quasi_static.hpp"

namespace palpate::study {
namespace {

/// A hybrid body whose two meshes meet at some nodes only: see on_one_mesh().
class JoinedAtNodes : public Method {
 public:
  JoinedAtNodes(int body, std::string name) : body_(body), name_(std::move(name)) {}
  int body() const override { return body_; }
  std::vector<Point> points() const override { return {{name_, "connection", "at some nodes", {}, false}}; }
  Result evaluate(const Point&) override {
    throw std::runtime_error(
        "the two meshes meet at some nodes only, and there is no converged solution to compare with: not assessed");
  }

 private:
  int body_;
  std::string name_;
};

Methods only(std::unique_ptr<Method> method) {
  Methods methods;
  methods.push_back(std::move(method));
  return methods;
}

}  // namespace

Methods methods_of(const CatheterSpec&, const StudiedBody& body) {
  return only(make_catheter(body.scene, body.index, body.options.quick));
}

Methods methods_of(const ModalShellSpec&, const StudiedBody& body) {
  return only(make_modal(body.scene, body.index, body.options.quick));
}

Methods methods_of(std::optional<OneMesh> whole, const StudiedBody& body, const std::vector<MovingModel>& models) {
  const Scene& scene = body.scene;
  if (!whole) {
    const std::string name = name_of(scene.bodies[body.index]);
    return only(std::make_unique<JoinedAtNodes>(body.index,
                                                scene.bodies.size() == 1 ? "hybrid" : fmt::format("{}:hybrid", name)));
  }
  const auto solid = std::make_shared<SolidCase>(scene, body.index, *std::move(whole), body.options.quick,
                                                 ReferenceCache(body.options.references), body.options.say);
  Methods methods = only(make_quasi_static(solid));
  methods.push_back(make_linearity(solid));
  for (const MovingModel& model : models) methods.push_back(make_dynamic(solid, model));
  return methods;
}

}  // namespace palpate::study
