#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "tests/scene/full_scene.hpp"

namespace palpate {
namespace {

/// One change of the full scene and the sentence that it must cause. `LINE` and `COLUMN` are those of the
/// text `at` within the changed scene.
struct Refusal {
  const char* find;
  const char* replace;
  const char* at;
  const char* sentence;
};

std::string replaced(std::string text, const std::string& find, const std::string& replace) {
  const auto place = text.find(find);
  EXPECT_NE(place, text.npos) << find;
  return text.replace(place, find.size(), replace);
}

std::string position(const std::string& text, const std::string& at) {
  const auto place = text.find(at);
  EXPECT_NE(place, text.npos) << at;
  const auto line_start = text.rfind('\n', place) + 1;
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(place), '\n');
  return ":" + std::to_string(line) + ":" + std::to_string(place - line_start + 1) + ": ";
}

const Refusal kRefusals[] = {
    {"young = 6000", "yuong = 6000", "yuong", "unknown key 'yuong' in [[body]]; did you mean 'young'?"},
    {"title =", "titel =", "titel", "unknown key 'titel' in scene; did you mean 'title'?"},
    {"[contact]", "[contakt]", "contakt", "unknown key 'contakt' in scene; did you mean 'contact'?"},
    {"young = 6000", "colour_of_the_moon = 1\nyoung = 6000", "colour_of",
     "unknown key 'colour_of_the_moon' in [[body]]"},
    {"young = 6000", "", "[[body]]", "[[body]] needs the key 'young'"},
    {"young = 6000", "young = \"6 kPa\"", "\"6 kPa", "young must be a number, not a string"},
    {"young = 6000", "young = -6000", "-6000", "young must be greater than 0 and at most 1e+20, and is -6000"},
    {"young = 6000", "young = 0", "0\npoisson", "young must be greater than 0 and at most 1e+20, and is 0"},
    {"young = 6000", "young = 1e300", "1e300", "young must be greater than 0 and at most 1e+20, and is 1e+300"},
    {"young = 6000", "young = nan", "nan", "young must be finite"},
    {"young = 6000", "young = +inf", "+inf", "young must be finite"},
    {"poisson = 0.45", "poisson = 0.5", "0.5\n", "poisson must be greater than -1 and less than 0.5, and is 0.5"},
    {"poisson = 0.45", "poisson = -1", "-1\n", "poisson must be greater than -1 and less than 0.5, and is -1"},
    {"density = 1060.0", "density = 0", "0\n\n[[body.fixed",
     "density must be greater than 0 and at most 1000000, and is 0"},
    {"scale = 0.001", "scale = -1", "-1\nmodel", "scale must be greater than 0, and is -1"},
    {"force = [0, 0, -0.5]", "force = [0, 0, -0.5]\npressure = 3", "[[body.load]]",
     "a [[body.load]] is either a 'force' or a 'pressure'"},
    {"pressure = -200", "", "[[body.load]]\nnodes", "a [[body.load]] is either a 'force' or a 'pressure'"},
    {"pressure = -200", "pressure = 2e9", "2e9",
     "pressure must be greater than -1000000000 and less than 1000000000, and is 2000000000"},
    {"\"quasi_static\"", "\"jelly\"", "\"jelly\"",
     "model 'jelly' is unknown; known: quasi_static, tensor_mass, spring_mass, hybrid, "
     "modal_shell, catheter"},
    {"\"quasi_static\"", "\"tensor_mass\"", "[body.nonlinear]",
     "[body.nonlinear] means nothing for the model 'tensor_mass'"},
    {"[body.touchable]\nnodes = [10, 11]", "[body.relaxation]\ntimes = [1]\nshares = [0.5]",
     "[body.relaxation]\ntimes = [1]",
     "[body.relaxation] does not go with [body.nonlinear], whose curves are those of one rate"},
    {"degree = 5", "degree = 5\nlaw = \"neo_hookean\"", "5\nlaw", "degree means nothing for the law 'neo_hookean'"},
    {"degree = 5", "degree = 5\nball_radius = 0.006", "0.006", "ball_radius means nothing for the law 'measured'"},
    {"degree = 5", "degree = 5\nplaces = 3", "3\nspecimen", "places means nothing for the law 'measured'"},
    {"degree = 5", "degree = 5\nlaw = \"ogden\"", "\"ogden\"", "law 'ogden' is unknown; known: measured, neo_hookean"},
    {"young = 1e6", "model = \"tensor_mass\"\nyoung = 1e6", "[body.relaxation]",
     "[body.relaxation] means nothing for the model 'tensor_mass'"},
    {"times = [0.1, 2]", "times = []", "[]", "times must not be empty"},
    {"times = [0.1, 2]", "times = [2, 0.1]", "[2, 0.1]", "times must ascend"},
    {"times = [0.1, 2]", "times = [0.1, -2]", "-2]\nshares", "times must be greater than 0, and one is -2"},
    {"times = [0.1, 2]", "times = [1, 2, 3, 4, 5, 6, 7, 8, 9]", "[1, 2, 3, 4", "times must be 8 at most, and are 9"},
    {"shares = [0.3, 0.25]", "shares = [0.3]", "[0.3]", "shares must be as many as times, 2, and are 1"},
    {"shares = [0.3, 0.25]", "shares = [0.7, 0.4]", "[0.7, 0.4]", "shares must together be less than 1, and are 1.1"},
    {"shares = [0.3, 0.25]", "shares = [0.3, 1]", "1]\n\n[[body]]\nname = \"third",
     "shares must be greater than 0 and less than 1, and one is 1"},
    {"model = \"hybrid\"\n", "", "[body.dynamic]", "[body.dynamic] means nothing for the model 'quasi_static'"},
    {"[body.touchable]\nnodes = [10, 11]", "[body.tearing]\nthreshold = 1", "[body.tearing]",
     "[body.tearing] means nothing for the model 'quasi_static'"},
    {"touchable = { group = \"top\" }", "hybrid = { mesh = \"coarse.msh\" }", "{ mesh = \"coarse.msh\" }",
     "[body.hybrid] means nothing for the model 'quasi_static'"},
    {"dynamic = { gravity", "hybrid = { mesh = \"coarse.msh\" }\ndynamic = { gravity", "{ mesh = \"coarse.msh\" }",
     "[body.hybrid] means nothing for the model 'spring_mass'"},
    {"hybrid = { mesh = \"coarse.msh\", scale = 0.01 }", "",
     "\"hybrid\"\nyoung = 4000\npoisson = 0.4\nfixed = [{ group = \"edge\" }]\n\n\n",
     "the model 'hybrid' needs a [body.hybrid]: which part is tensor-mass"},
    {"mesh = \"coarse.msh\", scale = 0.01", "", "{  }",
     "[body.hybrid] needs a [[body.hybrid.region]] or a 'mesh', and has neither"},
    {"[body.hybrid]\n", "[body.hybrid]\nmesh = \"coarse.msh\"\n", "[body.hybrid]",
     "[body.hybrid] needs a [[body.hybrid.region]] or a 'mesh', and has both"},
    {"[body.hybrid]\n", "[body.hybrid]\nscale = 0.5\n", "0.5\n\n[[body.hybrid.region]]",
     "scale means nothing without 'mesh'"},
    {"scale = 0.01 }", "scale = 0 }", "0 }\n\n[[body]]\nname = \"web\"", "scale must be greater than 0, and is 0"},
    {"[body.hybrid]\n", "[body.hybrid]\nregoin = 1\n", "regoin",
     "unknown key 'regoin' in [body.hybrid]; did you mean 'region'?"},
    {"elements = [4, 2]", "", "[[body.hybrid.region]]",
     "exactly one of 'elements', 'box' and 'group' is needed, and there are 0"},
    {"elements = [4, 2]", "nodes = [4, 2]", "nodes = [4", "unknown key 'nodes' in [[body.hybrid.region]]"},
    {"\"semi_implicit\"", "\"forward_euler\"", "\"forward_euler",
     "integrator 'forward_euler' is unknown; known: rk4, semi_implicit"},
    {"precision = \"double\"", "precision = \"half\"", "\"half", "precision 'half' is unknown; known: single, double"},
    {"step = 0.0005", "step = -0.0005", "-0.0005", "step must be at least 0, and is -0.0005"},
    {"damping = 12", "damping = -1", "-1\ngravity", "damping must be at least 0, and is -1"},
    {"gravity = [0, 0, -9.81]", "gravity = -9.81", "-9.81", "gravity must be a list of three numbers"},
    {"gravity = [0, 0, -9.81]", "gravity = [0, 0, nan]", "nan]", "gravity must be finite"},
    {"corotational = true", "corotational = 1", "1\n\n[body.tearing]",
     "corotational must be true or false, not an integer"},
    {"gravity = [0, 0, -1.5]", "corotational = true", "true }",
     "corotational is for elements, and springs turn with the tissue by themselves"},
    {"element = \"linear\"", "element = \"quadratic\"", "\"quadratic",
     "element 'quadratic' is unknown; known: linear, nodal_strain"},
    {"element = \"linear\"", "element = \"nodal_strain\"", "true\n\n[body.tearing]",
     "elements that turn with the tissue are linear: take either corotational or element = \"nodal_strain\""},
    {"gravity = [0, 0, -1.5]", "element = \"nodal_strain\"", "\"nodal_strain\" }",
     "nodal_strain is for elements, and springs have no strain to average"},
    {"damping = 12", "dampnig = 12", "dampnig", "unknown key 'dampnig' in [body.dynamic]; did you mean 'damping'?"},
    {"\"mean_elongation\"", "\"strain\"", "\"strain",
     "criterion 'strain' is unknown; known: volume, mean_elongation, max_elongation"},
    {"threshold = 0.7", "threshold = 0", "0\n\n[body.hybrid]", "threshold must be greater than 0, and is 0"},
    {"threshold = 0.7", "threshold = -0.7", "-0.7", "threshold must be greater than 0, and is -0.7"},
    {"threshold = 0.7", "", "[body.tearing]", "[body.tearing] needs the key 'threshold'"},
    {"fixed = [{ group = \"edge\" }]\ndynamic", "dynamic", "[[body]]\nname = \"web\"",
     "body 'web' is not fixed anywhere and would float: give it a [[body.fixed]]"},
    {"radius = 0.002\n\n[tool.jaws]", "radius = -0.002\n\n[tool.jaws]", "-0.002",
     "radius must be greater than 0, and is -0.002"},
    {"radius = 0.002\n\n[tool.jaws]", "power = 30\n\n[tool.jaws]", "power", "unknown key 'power' in [tool.cautery]"},
    {"length = 0.02\n", "length = 0\n", "0\nwidth", "length must be greater than 0, and is 0"},
    {"width = 0.005", "width = -1", "-1\nclosed", "width must be greater than 0, and is -1"},
    {"closed_below = 0.2", "closed_below = 0", "0\n\n[[tool]]", "closed_below must be greater than 0, and is 0"},
    {"axes = \"xz\"", "rotations = true", "true\n\n[[body.fixed]]\nbox",
     "rotations means nothing for the model 'quasi_static'"},
    {"rotations = false", "rotations = 0", "0\n\n[body.shell]", "rotations must be true or false, not an integer"},
    {"\n[body.shell]\nthickness = 0.001\nbending = \"polynomial\"\nmodes = 40\ndamping = 3\nresidual = false\n", "",
     "\"modal_shell\"", "the model 'modal_shell' needs a [body.shell]: the wall"},
    {"[body.shell]\nthickness = 0.001", "[body.shell]", "[body.shell]", "[body.shell] needs the key 'thickness'"},
    {"thickness = 0.001", "thickness = 0", "0\nbending", "thickness must be greater than 0, and is 0"},
    {"thickness = 0.001", "thickness = -0.001", "-0.001", "thickness must be greater than 0, and is -0.001"},
    {"thickness = 0.001", "thinkness = 0.001", "thinkness",
     "unknown key 'thinkness' in [body.shell]; did you mean 'thickness'?"},
    {"\"polynomial\"", "\"thick\"", "\"thick\"", "bending 'thick' is unknown; known: discrete_kirchhoff, polynomial"},
    {"modes = 40", "modes = 0", "0\ndamping", "modes must be at least 1 and at most 100000, and is 0"},
    {"modes = 40", "modes = 4.5", "4.5\ndamping", "modes must be an integer, not a number"},
    {"damping = 3\n", "damping = 0\n", "0\nresidual", "damping must be greater than 0, and is 0"},
    {"damping = 3\n", "damping_ratio = -0.1\n", "-0.1\nresidual", "damping_ratio must be at least 0, and is -0.1"},
    {"damping = 3\n", "damping_ratio = 0.1\ndamping = 3\n", "3\nresidual",
     "damping and damping_ratio are two laws of damping: give one of them"},
    {"residual = false", "residual = \"no\"", "\"no\"", "residual must be true or false, not a string"},
    {"gravity = [0, 0, -9.81]\nmodel = \"modal_shell\"", "model = \"tensor_mass\"", "[body.shell]",
     "[body.shell] means nothing for the model 'tensor_mass'"},
    {"model = \"modal_shell\"", "model = \"tensor_mass\"", "[0, 0, -9.81]\nmodel",
     "gravity means nothing for the model 'tensor_mass'"},
    {"touchable = { nodes = [1, 2] }", "material = [{ group = \"a\", young = 1 }]", "[{ group = \"a\", y",
     "[[body.material]] means nothing for the model 'modal_shell'"},
    {"touchable = { nodes = [1, 2] }", "dynamic = { }", "{ }",
     "[body.dynamic] means nothing for the model 'modal_shell'"},
    {"touchable = { nodes = [1, 2] }", "tearing = { threshold = 1 }", "{ threshold = 1",
     "[body.tearing] means nothing for the model 'modal_shell'"},
    {"touchable = { nodes = [1, 2] }", "hybrid = { mesh = \"coarse.msh\" }",
     "{ mesh = \"coarse.msh\" }\n\n[[body.fixed]]", "[body.hybrid] means nothing for the model 'modal_shell'"},
    {"touchable = { nodes = [1, 2] }", "nonlinear = { radius = 1 }", "{ radius = 1",
     "[body.nonlinear] means nothing for the model 'modal_shell'"},
    {"touchable = { nodes = [1, 2] }", "catheter = { }", "{ }",
     "[body.catheter] means nothing for the model 'modal_shell'"},
    {"thickness = 0.001", "", "[body.shell]", "[body.shell] needs the key 'thickness'"},
    {"young = 3e7\n\n[body.catheter]", "young = 3e7\n\n[body.shell]", "[body.shell]\ninside",
     "[body.shell] means nothing for the model 'catheter'"},
    {"young = 3e7\n", "young = 3e7\nmesh = \"tube.stl\"\n", "\"tube.stl\"\n\n[body.catheter]",
     "mesh means nothing for the model 'catheter'"},
    {"young = 3e7\n", "young = 3e7\nscale = 2\n", "2\n\n[body.catheter]",
     "scale means nothing for the model 'catheter'"},
    {"young = 3e7\n", "young = 3e7\nfixed = [{ group = \"b\" }]\n", "[{ group = \"b",
     "[[body.fixed]] means nothing for the model 'catheter'"},
    {"young = 3e7\n", "young = 3e7\ntouchable = { group = \"b\" }\n", "{ group = \"b",
     "[body.touchable] means nothing for the model 'catheter'"},
    {"young = 3e7\n", "young = 3e7\nmaterial = []\n", "[]\n\n[body.catheter]",
     "[[body.material]] means nothing for the model 'catheter'"},
    {"young = 3e7\n", "young = 3e7\ndynamic = {}\n", "{}\n\n[body.catheter]",
     "[body.dynamic] means nothing for the model 'catheter'"},
    {"young = 3e7\n", "young = 3e7\nnonlinear = {}\n", "{}\n\n[body.catheter]",
     "[body.nonlinear] means nothing for the model 'catheter'"},
    {"inside = \"cystic_duct\"", "inside = \"aorta\"", "\"aorta\"",
     "inside must name a body of the model 'modal_shell', and is 'aorta': the scene has no such body"},
    {"inside = \"cystic_duct\"", "inside = \"segment\"", "\"segment\"\ntail",
     "inside must name a body of the model 'modal_shell', and is 'segment': that body's model is 'hybrid'"},
    {"tail = [-0.14, 0, 0.01]", "", "[body.catheter]", "[body.catheter] needs the key 'tail'"},
    {"tip = [-0.02, 0, 0.01]", "tip = [-0.14, 0, 0.01]", "[-0.14, 0, 0.01]\nradius",
     "the catheter's tail and tip must not coincide"},
    {"radius = 0.0013", "radius = 0", "0\nparticles", "radius must be greater than 0, and is 0"},
    {"particles = 61", "particles = 3", "3\nsleeve", "particles must be at least 4 and at most 10000, and is 3"},
    {"sleeve = 0.03", "sleeve = 0.13", "0.13\n",
     "sleeve must be shorter than the catheter, which is 0.12 m long, and is 0.13"},
    {"sleeve = 0.03", "sleeve = -0.03", "-0.03\ndamping", "sleeve must be at least 0, and is -0.03"},
    {"integrator = \"semi_implicit\"\n\n[[tool]]", "integrator = \"rk4\"\n\n[[tool]]", "\"rk4\"",
     "integrator 'rk4' is unknown; known: implicit, semi_implicit"},
    {"kind = \"forceps\"", "kind = \"tweezers\"", "\"tweezers\"", "kind 'tweezers' is unknown; known: probe, forceps"},
    {"kind = \"forceps\"\n", "", "0.6\n\n[[tool]]", "friction means nothing for the kind 'probe'"},
    {"name = \"hook\"\n", "name = \"hook\"\nkind = \"forceps\"\n", "\"forceps\"\npivot = [0, 0, 0.3]",
     "the kind 'forceps' needs a [tool.jaws]: two jaws at the tip; needed for a forceps"},
    {"kind = \"forceps\"\n", "kind = \"forceps\"\nradius = 0.004\n", "0.004\npivot",
     "radius means nothing for the kind 'forceps'"},
    {"compliance = 0.0002\n", "cautery = {}\n", "{}\n\n[tool.jaws]",
     "[tool.cautery] means nothing for the kind 'forceps'"},
    {"compliance = 0.0002", "compliance = 0", "0\n\n[tool.jaws]", "compliance must be greater than 0, and is 0"},
    {"radius = 0.0012", "width = 0.005", "0.005\nmax_open", "width means nothing for the kind 'forceps'"},
    {"radius = 0.0012", "closed_below = 0.1", "0.1\nmax_open", "closed_below means nothing for the kind 'forceps'"},
    {"closed_below = 0.2", "max_open = 1", "1\n\n[[tool]]", "max_open means nothing for the kind 'probe'"},
    {"max_open = 0.9", "max_open = 0", "0\ngrip", "max_open must be greater than 0 and at most 2.5, and is 0"},
    {"max_open = 0.9", "max_open = 2.6", "2.6\ngrip", "max_open must be greater than 0 and at most 2.5, and is 2.6"},
    {"grip_stiffness = 0.4", "grip_stiffness = 0", "0\nfriction", "grip_stiffness must be greater than 0, and is 0"},
    {"friction = 0.6", "friction = -1", "-1\n\n[[tool]]", "friction must be at least 0, and is -1"},
    {"refine = 1", "refine = 3", "3\nelement", "refine must be at least 0 and at most 2, and is 3"},
    {"element = \"p2\"", "element = \"p3\"", "\"p3", "element 'p3' is unknown; known: p1, p2"},
    {"keys = \"keys\"", "", "[network.security]", "[network.security] needs the key 'keys'"},
    {"keys = \"keys\"", "keys = 3", "3\n\n[rates", "keys must be a string, not an integer"},
    {"reserve = 0.02", "reserve = -1", "-1\n\n[network]", "reserve must be at least 0, and is -1"},
    {"name = \"liver\"", "name = \"\"", "\"\"", "name must not be empty"},
    {"name = \"liver\"", "name = \"a/b\"", "\"a/b", "name 'a/b' must be 1 to 31 letters, digits, '_' or '-'"},
    {"name = \"plate\"", "name = \"liver\"", "\"liver\"\nmesh = \"liver.msh\"\nyoung",
     "a second body is named 'liver'"},
    {"name = \"hook\"", "name = \"probe\"", "\"probe\"\npivot = [0, 0", "a second tool is named 'probe'"},
    {"nodes = [3, 1, 2]", "nodes = []", "[]", "nodes must not be empty"},
    {"nodes = [3, 1, 2]", "nodes = [3, -1]", "-1]", "nodes counts from 0, and -1 is out of range"},
    {"nodes = [3, 1, 2]", "nodes = [3, 1.5]", "1.5", "nodes must hold integers, not a number"},
    {"nodes = [3, 1, 2]", "nodes = [3, 1, 3]", "3]", "nodes holds 3 twice"},
    {"nodes = [3, 1, 2]", "nodes = 3", "3\naxes", "nodes must be a list of integers, not an integer"},
    {"nodes = [3, 1, 2]", "", "[[body.fixed]]", "exactly one of 'nodes', 'box' and 'group' is needed, and there are 0"},
    {"nodes = [3, 1, 2]", "nodes = [3]\ngroup = \"a\"", "[[body.fixed]]",
     "exactly one of 'nodes', 'box' and 'group' is needed, and there are 2"},
    {"axes = \"xz\"", "axes = \"xq\"", "\"xq\"", "axes 'xq' must name each of x, y and z once at most"},
    {"axes = \"xz\"", "axes = \"xx\"", "\"xx\"", "axes 'xx' must name each of x, y and z once at most"},
    {"axes = \"xz\"", "axes = \"\"", "\"\"", "axes must not be empty"},
    {"[[-0.1, -0.1, -0.1], [0.1, 0.2, 0.3]]", "[[0, 0, 0], [0.1, -0.2, 0.3]]", "[[0, 0, 0], [0.1, -",
     "box must be [[least x, y, z], [greatest x, y, z]]"},
    {"[[-0.1, -0.1, -0.1], [0.1, 0.2, 0.3]]", "[[0, 0, 0], [0.1, 0.3]]", "[0.1, 0.3]",
     "box must be a list of three numbers"},
    {"[[-0.1, -0.1, -0.1], [0.1, 0.2, 0.3]]", "[0, 1]", "0, 1]", "box must be a list of three numbers"},
    {"[[-0.1, -0.1, -0.1], [0.1, 0.2, 0.3]]", "[0, 1, 2]", "[0, 1, 2]", "box must be [[x, y, z], [x, y, z]]"},
    {"elements = [7, 8]\nyoung = 1e5", "elements = [7, 8]", "[[body.material]]",
     "[[body.material]] needs at least one of 'young', 'poisson' and 'density'"},
    {"elements = [7, 8]", "nodes = [7, 8]", "nodes = [7", "unknown key 'nodes' in [[body.material]]"},
    {"degree = 5", "degree = 11", "11\nspecimen", "degree must be at least 4 and at most 10, and is 11"},
    {"degree = 5", "degree = 5.0", "5.0", "degree must be an integer, not a number"},
    {"specimen_mesh = \"specimen.msh\"", "", "0.1\n\n[body.touch",
     "specimen_scale means nothing without 'specimen_mesh'"},
    {"fixed = [{ group = \"edge\" }]", "", "[[body]]\nname = \"plate\"",
     "body 'plate' is not fixed anywhere and would float: give it a [[body.fixed]]"},
    {"fixed = [{ group = \"edge\" }]", "fixed = { group = \"edge\" }", "{ group = \"edge\" }",
     "fixed must be a list of tables, not a table: write [[body.fixed]]"},
    {"pivot = [0.1, 0.2, 0.3]", "", "[[tool]]", "[[tool]] needs the key 'pivot'"},
    {"pivot = [0.1, 0.2, 0.3]", "pivot = [0.1, 0.2]", "[0.1, 0.2]\naxis", "pivot must be a list of three numbers"},
    {"pivot = [0.1, 0.2, 0.3]", "pivot = [0.1, true, 0]", "true, 0]", "pivot must be a number, not a boolean"},
    {"axis = [1, 2, -3]", "axis = [0, 0, 0]", "[0, 0, 0]\nup", "axis must not be zero"},
    {"axis = [1, 2, -3]", "axis = [0, -2, 0]", "[0, 1, 0]\nradius", "up must not be parallel to the tool's axis"},
    {"radius = 0.006", "radius = 0", "0\nshaft_radius", "radius must be greater than 0, and is 0"},
    {"device = \"bus\"", "device = \"telepathy\"", "\"telepathy",
     "device 'telepathy' is unknown; known: scripted, log, bus, pointer, hand"},
    {"trajectory = \"move.csv\"", "", "[[tool]]", "[[tool]] needs the key 'trajectory'"},
    {"device = \"bus\"", "device = \"bus\"\ntrajectory = \"move.csv\"", "\"move.csv\"\n\n[[tool]]\nname = \"ghost\"",
     "trajectory means nothing for the device 'bus'"},
    {"rule = \"alpha\"", "rule = \"beta\"", "\"beta\"", "rule 'beta' is unknown; known: patch, barycentric, alpha"},
    {"friction = 0.1", "friction = -0.1", "-0.1\nbucket", "friction must be at least 0, and is -0.1"},
    {"domain = 7", "domain = 300", "300", "domain must be at least 0 and at most 230, and is 300"},
    {"domain = 7", "domain = 99999999999999", "99999",
     "domain must be at least 0 and at most 230, and is 99999999999999"},
    {"peers = [\"10.0.0.1\", \"10.0.0.2\"]", "peers = [1]", "1]\n\n[network.security",
     "peers must be a string, not an integer"},
    {"haptic_hz = 2000", "haptic_hz = 0", "0\nvisual", "haptic_hz must be at least 1 and at most 20000, and is 0"},
    {"overlay = false", "overlay = 0", "0\n\n[render.camera", "overlay must be true or false, not an integer"},
    {"[0.5, 0.2, 0.1]", "[0.5, 2, 0.1]", "[0.5, 2, 0.1]", "tissue_colour must be red, green and blue between 0 and 1"},
    {"target = [0.01, 0.02, 0.03]", "target = [0, -0.3, 0.2]", "[render.camera]",
     "the camera's eye and target must not coincide"},
    {"up = [0, 0, 1]", "up = [0, 0, 0]", "[0, 0, 0]\nfield",
     "up must be a direction across the camera's line of sight"},
    {"field_of_view = 60", "field_of_view = 180", "180",
     "field_of_view must be at least 1 and at most 170, and is 180"},
};

TEST(SceneRefusal, NamesTheExactPlaceAndTheReason) {
  const SceneFolder folder;
  const auto file = folder / "scene.toml";
  for (const Refusal& r : kRefusals) {
    const std::string text = replaced(kFullScene, r.find, r.replace);
    EXPECT_EQ(refusal(text, file), file.string() + position(text, r.at) + r.sentence) << r.find << " -> " << r.replace;
  }
}

TEST(SceneRefusal, MissingFilesAreNamed) {
  const SceneFolder folder;
  const auto file = folder / "scene.toml";
  for (const char* name : {"liver.msh", "tube.stl", "force.csv", "radial.csv", "specimen.msh", "coarse.msh", "move.csv",
                           "session.lcmlog", "ribs.stl"}) {
    const std::string absent = std::string("no_") + name;
    const std::string text = replaced(kFullScene, std::string("\"") + name, std::string("\"") + absent);
    const std::string said = refusal(text, file);
    EXPECT_TRUE(said.starts_with(file.string() + position(text, "\"no_"))) << said;
    EXPECT_NE(said.find((folder / absent).string()), said.npos) << said;
    EXPECT_TRUE(said.ends_with("is not a file that can be read")) << said;
  }
}

TEST(SceneRefusal, SyntaxErrorsHaveAPlaceToo) {
  const SceneFolder folder;
  const auto file = folder / "scene.toml";
  EXPECT_TRUE(refusal("title = \"a\"\n[[body]\n", file).starts_with(file.string() + ":2:"));
  EXPECT_TRUE(refusal("a = 1\na = 2\n", file).starts_with(file.string() + ":2:"));
  EXPECT_TRUE(refusal("title = \"\xff\"\n", file).starts_with(file.string() + ":1:"));
  EXPECT_TRUE(refusal("[=]\n", file).starts_with(file.string() + ":1:"));
  EXPECT_TRUE(refusal("x = " + std::string(100000, '['), file).starts_with(file.string() + ":1:"));
}

TEST(SceneRefusal, AnEmptySceneHasNoBody) {
  const SceneFolder folder;
  EXPECT_EQ(refusal("", folder / "s.toml"), (folder / "s.toml").string() + ":1:1: the scene has no [[body]]");
  EXPECT_EQ(refusal("body = []", folder / "s.toml"), (folder / "s.toml").string() + ":1:1: the scene has no [[body]]");
}

TEST(SceneRefusal, AKeyOfVeryManyPartsIsRefusedBeforeItIsParsed) {
  const SceneFolder folder;
  std::string deep = "a";
  for (int part = 0; part < 200'000; ++part) deep += ".a";
  const std::string said = (folder / "s.toml").string() + ":2:1: a key of more than 65 parts";
  EXPECT_EQ(refusal("\n" + deep + " = 1", folder / "s.toml"), said);
  EXPECT_EQ(refusal("\n[" + deep + "]", folder / "s.toml"), said);
  EXPECT_EQ(refusal("title = \"" + deep + "\"", folder / "s.toml"),
            (folder / "s.toml").string() + ":1:1: the scene has no [[body]]");
}

TEST(SceneRefusal, APipeIsNoScene) {
  const SceneFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe.toml").c_str(), 0600), 0);
  EXPECT_THROW(load_scene(folder / "pipe.toml"), std::runtime_error) << "and it is not waited for";
}

TEST(SceneRefusal, AMissingSceneFileIsNamed) {
  EXPECT_THROW(
      {
        try {
          load_scene("/nowhere/scene.toml");
        } catch (const std::runtime_error& error) {
          EXPECT_STREQ(error.what(), "/nowhere/scene.toml:1:1: the scene is not a file that can be read");
          throw;
        }
      },
      std::runtime_error);
  EXPECT_THROW(load_scene("/tmp"), std::runtime_error);
}

}  // namespace
}  // namespace palpate
