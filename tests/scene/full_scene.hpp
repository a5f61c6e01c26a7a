#pragma once
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "common/scene/scene.hpp"

namespace palpate {

/// A folder with the files that the scene below names, gone with the object.
class SceneFolder {
 public:
  SceneFolder() {
    char name[] = "/tmp/palpate_scene_XXXXXX";
    path_ = mkdtemp(name);
    for (const char* file : {"liver.msh", "tube.stl", "force.csv", "radial.csv", "specimen.msh", "coarse.msh",
                             "move.csv", "session.lcmlog", "ribs.stl", "organ.obj", "organ.mtl", "organ.png"})
      write(file, "some bytes\n");
  }
  ~SceneFolder() { std::filesystem::remove_all(path_); }
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// Holds every table, and of its keys those whose reading and writing is tried by it.
inline const std::string kFullScene = R"(title = "All \"keys\" at once"

[[body]]
name = "liver"
mesh = "liver.msh"
scale = 0.001
model = "quasi_static"
young = 6000
poisson = 0.45
density = 1060.0

[[body.fixed]]
nodes = [3, 1, 2]
axes = "xz"

[[body.fixed]]
box = [[-0.1, -0.1, -0.1], [0.1, 0.2, 0.3]]

[[body.fixed]]
group = "attachment"

[[body.material]]
elements = [7, 8]
young = 1e5

[[body.material]]
box = [[0, 0, 0], [1, 1, 1]]
poisson = 0.3333333333333333

[[body.material]]
group = 7
density = 900

[body.nonlinear]
force_curve = "force.csv"
radial_curve = "radial.csv"
radius = 0.015
height = 0.013
degree = 5
specimen_mesh = "specimen.msh"
specimen_scale = 0.1

[body.touchable]
nodes = [10, 11]

[[body.load]]
group = "attachment"
force = [0, 0, -0.5]

[[body.load]]
nodes = [14, 15, 16]
pressure = -200

[body.offline]
refine = 1
element = "p2"
formulation = "locking_free"

[body.visual]
surface = "organ.obj"
materials = "organ.mtl"
texture = "organ.png"
scale = 0.001

[[body]]
name = "plate"
mesh = "liver.msh"
young = 1e6
poisson = 0.3
fixed = [{ group = "edge" }]
touchable = { box = [[0, 0, 0], [1, 1, 0]] }

[body.relaxation]
times = [0.1, 2]
shares = [0.3, 0.25]

[[body]]
name = "third"
mesh = "liver.msh"
young = 1
poisson = 0
fixed = [{ group = "edge" }]
touchable = { group = "top" }

[[body]]
name = "segment"
mesh = "liver.msh"
model = "hybrid"
young = 4000
poisson = 0.4
fixed = [{ group = "edge" }]

[body.dynamic]
element = "linear"
integrator = "semi_implicit"
precision = "double"
step = 0.0005
damping = 12
gravity = [0, 0, -9.81]
resect = [[-0.5, -0.5, 0.01], [0.5, 0.5, 0.5]]
corotational = true

[body.tearing]
criterion = "mean_elongation"
threshold = 0.7

[body.hybrid]

[[body.hybrid.region]]
elements = [4, 2]

[[body.hybrid.region]]
box = [[0, 0, 0], [0.01, 0.02, 0.03]]

[[body.hybrid.region]]
group = 5

[[body]]
name = "duct"
mesh = "liver.msh"
model = "hybrid"
young = 4000
poisson = 0.4
fixed = [{ group = "edge" }]
hybrid = { mesh = "coarse.msh", scale = 0.01 }

[[body]]
name = "web"
mesh = "liver.msh"
model = "spring_mass"
young = 4000
poisson = 0.4
fixed = [{ group = "edge" }]
dynamic = { gravity = [0, 0, -1.5] }

[[body]]
name = "cystic_duct"
mesh = "tube.stl"
gravity = [0, 0, -9.81]
model = "modal_shell"
young = 2e5
poisson = 0.45
touchable = { nodes = [1, 2] }

[[body.fixed]]
nodes = [0, 5]
axes = "xy"
rotations = false

[body.shell]
thickness = 0.001
bending = "polynomial"
modes = 40
damping = 3
residual = false

[[body.load]]
box = [[0, 0, 0], [1, 1, 1]]
force = [0.1, 0, 0]

[[body]]
name = "wire"
model = "catheter"
young = 3e7

[body.catheter]
inside = "cystic_duct"
tail = [-0.14, 0, 0.01]
tip = [-0.02, 0, 0.01]
radius = 0.0013
particles = 61
sleeve = 0.03
damping = 4
gravity = [0, 0, -9.5]
integrator = "semi_implicit"

[[tool]]
name = "probe"
pivot = [0.1, 0.2, 0.3]
axis = [1, 2, -3]
up = [0, 1, 0]
radius = 0.006
shaft_radius = 0.002
shaft_length = 0.25
device = "scripted"
trajectory = "move.csv"
max_force = 8
max_force_rate = 4000
force_scale = 0.5

[tool.motion]
max_angle = 1.2
min_depth = 0.01
max_depth = 0.25
max_speed = 0.5
max_turn = 9
jump = 0.02
jump_angle = 0.4

[tool.cautery]
radius = 0.002

[tool.jaws]
length = 0.02
width = 0.005
closed_below = 0.2

[[tool]]
name = "hook"
pivot = [0, 0, 0.3]
device = "bus"

[[tool]]
name = "ghost"
pivot = [0, 0, 0.3]
device = "log"
trajectory = "session.lcmlog"

[[tool]]
name = "grasper"
kind = "forceps"
pivot = [0, 0.1, 0.3]
device = "bus"
lease = 0.2
motion_scale = 0.8
compliance = 0.0002

[tool.jaws]
length = 0.015
radius = 0.0012
max_open = 0.9
grip_stiffness = 0.4
friction = 0.6

[[tool]]
name = "finger"
pivot = [0, 0, 0.3]
device = "pointer"
start = [0, 0, 0.1]
lease = 0.3
delay = 0.03
max_speed = 0.2

[[tool]]
name = "pen"
pivot = [0, 0, 0.3]
device = "hand"
trajectory = "move.csv"
mass = 0.3
damping = 4
stiffness = 400

[contact]
rule = "alpha"
friction = 0.1
bucket_size = 0.01

[passivity]
controller = false
reserve = 0.02

[network]
domain = 7
interface = "eth0"
peers = ["10.0.0.1", "10.0.0.2"]

[network.security]
keys = "keys"

[rates]
haptic_hz = 2000
visual_hz = 90.5

[record]
file = "out/session.lcmlog"

[render]
width = 640
height = 480
colour = "displacement"
tissue_colour = [0.5, 0.2, 0.1]
backdrop = "ribs.stl"
backdrop_scale = 0.01
overlay = false

[render.camera]
eye = [0, -0.3, 0.2]
target = [0.01, 0.02, 0.03]
up = [0, 0, 1]
field_of_view = 60

[web]
address = "10.0.0.3"
port = 9000
)";

/// The least that is a scene.
inline const std::string kMinimalScene = R"([[body]]
name = "liver"
mesh = "liver.msh"
young = 6000
poisson = 0.45

[[body.fixed]]
group = "attachment"
)";

/// The sentence with which a scene's text is refused.
inline std::string refusal(const std::string& text, const std::filesystem::path& file) {
  try {
    parse_scene(text, file);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace palpate
