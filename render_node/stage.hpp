#pragma once
#include <optional>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/contact/patch/hertz_dent.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/tool/kinematics.hpp"
#include "common/view/draw_list.hpp"
#include "common/view/looks.hpp"
#include "common/view/visual_body.hpp"
#include "idl/messages.hpp"
#include "render_node/parts_on_stage.hpp"
#include "render_node/refine.hpp"
#include "render_node/thick_wall.hpp"
#include "render_node/visual_on_stage.hpp"

namespace palpate {

/// What is to be seen, as last heard: bodies, tools, backdrop and the overlay's words. Modal shells are walls with two
/// sides, catheters smooth tubes. Copies are snapshots.
class Stage {
 public:
  /// `surfaces`: one per body, at rest until set_surface. `backdrop` may be empty. `visuals`: none, or one per body,
  /// which may be empty. What is drawn is counted from `origin` [m] on, and so are the visuals already. Throws as
  /// decode_png().
  Stage(const Scene& scene, std::span<const SurfaceMap> surfaces, const TriangleMesh& backdrop,
        std::vector<std::optional<VisualBody>> visuals = {}, const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

  /// Colours a solid body by its parts and shows its mesh: `moving`, node indices of its tetrahedra that move. Nothing
  /// of a duct or a catheter.
  void colour_parts(int body, std::span<const std::array<int, 4>> moving);
  /// Shape of one body: position [m] from the origin on and unit normal per surface node; empty spans leave it as it
  /// is. `dents`: which the positions show at the nodes; between these they are drawn as they are, round.
  void set_surface(int body, std::span<const Eigen::Vector3f> position, std::span<const Eigen::Vector3f> normal,
                   std::span<const HertzDent> dents = {});
  /// Another surface of one body over the same nodes, after a cut: outward triangles.
  void set_triangles(int body, std::span<const std::array<int, 3>> triangles);
  bool has_visual(int body) const { return bodies_.at(body).visual.has_value(); }
  /// Before set_triangles(): which piece each tetrahedron belongs to after the cut, as VisualShape::part() takes it.
  void part_visual(int body, std::span<const int> piece) { bodies_.at(body).visual->part(piece); }
  /// False (and nothing set) if the scene has no such tool.
  bool set_tool(const ToolState& state);
  /// In the corner that the tools, each as it was seen first, leave free.
  void set_overlay(std::vector<std::string> lines, std::optional<Gauge> gauge);

  /// The picture's contents; the frame refers to this stage and is good until it changes.
  Frame frame() const;

 private:
  void add_backdrop(const TriangleMesh& mesh, Finish finish, const std::array<double, 3>& colour);
  void put_overlay_aside();
  struct Soft;
  void refine(Soft& body, std::span<const std::array<int, 3>> triangles) const;
  void add_wall(Soft& body, const BodyLook& look) const;
  void add_visual(Soft& body, VisualBody visual, const Body& spec, const SurfaceMap& map) const;
  static void smooth(Soft& body, std::span<const HertzDent> dents);
  static void dent(Soft& body, const HertzDent& dent);
  static void add_views(const Soft& body, int id, int inner_id, Frame& frame);

  struct Soft {
    Refinement refinement;
    std::uint64_t shape = 0;  ///< counts changes of the triangles
    std::size_t coarse;
    std::size_t max_triangles;  ///< after refinement
    Finish finish = Finish::tissue;
    std::array<double, 3> colour;
    std::vector<std::array<int, 3>> triangles;  ///< before refinement
    std::vector<Eigen::Vector3f> rest, rest_normal, position, normal;
    std::vector<Eigen::Vector3f> texture;  ///< coordinates that the texture sticks to; empty: rest
    std::vector<float> displacement;       ///< [m], empty unless coloured by it
    ThickWall wall;                        ///< of a modal shell
    std::vector<Eigen::Vector3f> inner_texture;
    std::vector<float> inner_displacement;
    std::optional<PartsOnStage> parts;      ///< if it is coloured by them
    std::optional<VisualOnStage> visual;    ///< is seen in place of the body's own surface
    std::vector<std::array<int, 3>> uncut;  ///< own surface before any cut, where there is a visual one
  };
  struct Rigid {
    std::vector<Eigen::Vector3f> position, normal;
    std::vector<std::array<int, 3>> triangles;
    Finish finish;
    std::array<double, 3> colour;
  };
  struct Instrument {
    Trocar trocar;
    InstrumentView view;
    bool seen = false;
  };

  Eigen::Vector3d origin_;
  Render render_;
  std::vector<Soft> bodies_;
  std::vector<Rigid> backdrop_;
  std::vector<Instrument> tools_;
  double legend_max_ = 1e-3;  ///< [m] grows with what is seen
  Overlay overlay_;
};

}  // namespace palpate
