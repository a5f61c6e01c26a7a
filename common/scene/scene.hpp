#pragma once
#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// Axis-aligned box [m], world frame.
struct Box {
  Eigen::Vector3d min, max;
};

/// Selects nodes or elements of a mesh; exactly one member is set in a validated scene.
struct Selector {
  std::vector<int> indices;  ///< `nodes` or `elements`: 0-based
  std::optional<Box> box;
  std::string group;  ///< physical group: name or number
};

struct FixedRegion {
  Selector where;
  std::array<bool, 3> axes{true, true, true};  ///< which of x, y, z are held
  bool rotations = true;                       ///< a shell's rotations are held too: clamped, not hinged
};

struct Material {
  double young = 0;       ///< [Pa]
  double poisson = 0;     ///< [1], > -1, < 0.5
  double density = 1000;  ///< [kg/m^3]
};

struct MaterialRegion {
  Selector where;
  Material material;
};

/// Quasi non-linear correction (TVCG99 sec. 3-4, 4-3).
struct Nonlinear {
  std::filesystem::path force_curve;   ///< CSV `displacement_m,force_N`
  std::filesystem::path radial_curve;  ///< CSV `displacement_m,radial_m`
  double specimen_radius = 0;          ///< [m]
  double specimen_height = 0;          ///< [m]
  int degree = 6;                      ///< 4..10
  std::filesystem::path
      specimen_mesh;          ///< empty: ends slide, closed-form linear curves; else stuck ends, from this mesh
  double specimen_scale = 1;  ///< [m per unit of specimen_mesh]
};

/// Motion of tissue that is cut or torn (RR3510 sec. 4); means nothing to a quasi-static body.
struct Dynamic {
  std::string integrator = "rk4";                     ///< rk4 | semi_implicit
  std::string precision = "single";                   ///< single | double
  double step = 0;                                    ///< [s] 0: chosen from the frequency bound
  double damping = 5;                                 ///< [1/s] proportional to mass: gamma_i = damping * m_i
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]
  bool corotational = false;                          ///< elements turn with the tissue
};

/// When dynamic tissue tears by itself (RR3510 sec. 4.4).
struct Tearing {
  std::string criterion = "volume";  ///< volume | mean_elongation | largest_elongation
  double threshold = 0;              ///< [1] > 0, relative change
};

/// Which part of a hybrid body is tensor-mass; either regions or a mesh is set in a validated scene.
struct Hybrid {
  std::vector<Selector> regions;  ///< elements of the body's mesh: the tensor-mass part
  std::filesystem::path mesh;     ///< a coarse tensor-mass mesh joined where its nodes coincide with the body's
  double scale = 1;               ///< [m per unit of mesh]
};

/// A thin wall of shell triangles that moves by its lowest modes (BHS01 sec. V-C-1). The mesh is the wall's middle
/// surface.
struct Shell {
  double thickness = 0;                        ///< [m]
  std::string bending = "discrete_kirchhoff";  ///< discrete_kirchhoff | polynomial (BHS01 app. A)
  int modes = 50;                              ///< kept, the lowest ones
  double damping_ratio = 0.2;                  ///< [1] of every mode; means nothing with a damping
  double damping = 0;                          ///< [1/s] B = damping M (BHS01 eq. 21); 0: the ratio holds
  bool residual = true;                        ///< static share of the modes left out, at touched nodes
};

/// A flexible catheter of particles (BHS01 sec. V-C-2), straight at rest. Young's modulus and density are the body's.
struct Catheter {
  std::string inside;                              ///< name of the modal_shell body that it is led into; empty: none
  Eigen::Vector3d tail = Eigen::Vector3d::Zero();  ///< [m] first particle at rest
  Eigen::Vector3d tip = Eigen::Vector3d::UnitX();  ///< [m] last particle at rest
  double radius = 0.00125;                         ///< [m]
  int particles = 60;
  double sleeve = 0;   ///< [m] of a straight fixed sleeve that guides it, from `tail` towards `tip`
  double damping = 5;  ///< [1/s] force -damping m v on a particle
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]
  std::string integrator = "implicit";                ///< implicit | semi_implicit (BHS01 eq. 28, in substeps)
};

/// What `precompute` takes the tensors from, where that is better than the body's own mesh. Run time sees the same
/// surface and the same number of tensors.
struct Offline {
  int refine = 0;                            ///< times that every tetrahedron is split into eight
  std::string element = "p1";                ///< p1 | p2: linear or quadratic displacement
  std::string formulation = "displacement";  ///< displacement | locking_free
};

struct Body {
  std::string name;
  std::filesystem::path mesh;          ///< empty for a catheter
  double scale = 1;                    ///< [m per mesh unit]
  std::string model = "quasi_static";  ///< quasi_static | tensor_mass | spring_mass | hybrid | modal_shell | catheter
  Material material;
  std::vector<FixedRegion> fixed;
  std::vector<MaterialRegion> materials;  ///< empty: one material, nothing is stored per element
  std::optional<Nonlinear> nonlinear;
  std::optional<Selector> touchable;  ///< absent: every free surface node
  std::optional<Offline> offline;     ///< absent: the mesh itself with linear elements; of quasi_static bodies alone
  Dynamic dynamic;                    ///< defaults where the section is absent
  std::optional<Tearing> tearing;
  std::optional<Hybrid> hybrid;      ///< set exactly for the model hybrid
  std::optional<Shell> shell;        ///< set exactly for the model modal_shell
  std::optional<Catheter> catheter;  ///< set exactly for the model catheter
};

/// Whether the deformation node owns the body's state, and it can be cut: tensor_mass, spring_mass and hybrid.
bool is_dynamic(const Body& body);

/// An electric scalpel: removes the dynamic tissue that the tip touches while the pedal is down.
struct Cautery {
  double radius = 0;  ///< [m] of the sphere that cuts, about the tip's centre
};

/// Two jaws at the tip that hold the tissue between them once closed.
struct Jaws {
  double length = 0.012;      ///< [m] along the shaft
  double width = 0.006;       ///< [m] across the plane they open in
  double closed_below = 0.1;  ///< [rad] of grip; a forceps has no use for it: its jaws close until they touch
  // Of a forceps alone:
  double radius = 0.001;        ///< [m] of each jaw about its segment
  double most_open = 1.0;       ///< [rad] between the jaws
  double grip_stiffness = 0.5;  ///< [N m/rad] of the handle's linkage: closing torque per angle beyond the touch
  double friction = 0.8;        ///< [1] between jaws and what they hold; beyond it the hold slips
};

struct Tool {
  std::string name;
  std::string kind = "probe";  ///< probe: spheres along tip and shaft | forceps: segments of shaft and two jaws
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();   ///< [m] trocar point, world frame
  Eigen::Vector3d axis = -Eigen::Vector3d::UnitZ();  ///< unit, direction of the shaft (handle to tip) in the zero pose
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();  ///< unit, perpendicular part used: the tool's y axis in the zero pose
  double radius = 0.004;                          ///< [m] of the spherical tip
  double shaft_radius = 0.0025;                   ///< [m]
  double shaft_length = 0.3;                      ///< [m] from the tip back along the shaft
  std::string device = "scripted";                ///< scripted | log | bus
  std::filesystem::path trajectory;               ///< for scripted: CSV; for log: an LCM event log
  double compliance = 1e-4;      ///< [m/N] of the instrument itself, against bodies with inertia in the haptic node
  double max_force = 10;         ///< [N] limit of the safety chain
  double max_force_rate = 5000;  ///< [N/s] slew limit
  std::optional<Cautery> cautery;
  std::optional<Jaws> jaws;
};

struct Contact {
  std::string rule = "barycentric";  ///< barycentric | alpha (TVCG99 sec. 5)
  double friction = 0.3;             ///< [1] Coulomb coefficient; 0 slides freely
  double bucket_size = 0;            ///< [m] 0: twice the mean edge length of the surface
};

/// Watch over the energy that all tools together take from the tissue.
struct Passivity {
  bool controller =
      true;               ///< damps the tools that take out more than they put in and the reserve; false: observed only
  double reserve = 0.01;  ///< [J] that may be taken out beyond what was put in
};

/// Only who has keys of one authority takes part, and what crosses the network is encrypted.
struct Security {
  std::filesystem::path keys;  ///< folder that `palpate keys` made, or that of one role in it
};

struct Network {
  int domain = 0;
  std::string interface;  ///< empty: loopback
  std::vector<std::string> peers;
  std::optional<Security> security;  ///< absent: open to all, and nothing of it is loaded
};

struct Rates {
  double haptic_hz = 1000;
  double visual_hz = 60;
};

struct Record {
  std::filesystem::path file;
};

struct Camera {
  Eigen::Vector3d eye{0, -0.3, 0.2};
  Eigen::Vector3d target{0, 0, 0};
  Eigen::Vector3d up{0, 0, 1};
  double field_of_view = 50;  ///< [deg] vertical
};

struct Render {
  int width = 1024;
  int height = 768;
  Camera camera;
  std::string colour = "tissue";                          ///< tissue | displacement
  std::array<double, 3> tissue_colour{0.55, 0.16, 0.13};  ///< linear RGB
  std::filesystem::path backdrop;                         ///< empty: none
  double backdrop_scale = 1;                              ///< [m per mesh unit]
  bool overlay = true;
};

/// A validated scene with every default filled in. Paths are absolute. Optional sections that are absent
/// stay empty, and nothing is built for them.
struct Scene {
  std::filesystem::path file;
  std::string title;
  std::vector<Body> bodies;
  std::vector<Tool> tools;
  Contact contact;
  Passivity passivity;
  Network network;
  Rates rates;
  std::optional<Record> record;
  std::optional<Render> render;
};

/// Reads and validates. Throws std::runtime_error("FILE:LINE:COLUMN: sentence").
Scene load_scene(const std::filesystem::path& file);

/// The same for text that stands for the contents of `file`: paths in it are relative to that file's folder.
Scene parse_scene(std::string_view text, const std::filesystem::path& file);

/// The resolved scene as TOML, every default written out; load_scene reads it back to the same scene.
std::string to_toml(const Scene& scene);

/// Hash (XXH3, 128 bits, 32 hexadecimal digits) of what two nodes must agree on: bodies, tools, contact law,
/// rates and the contents of the curve files. What each node may choose for itself is left out: title, paths,
/// devices, network, record, render. Meshes are compared by the hash of the archive. Throws std::runtime_error if a
/// curve file cannot be read.
std::string scene_hash(const Scene& scene);

}  // namespace palpate
