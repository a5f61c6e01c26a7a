#include <gmsh.h>

#include <stdexcept>

#include "common/mesh/child.hpp"
#include "common/mesh/gmsh_calls.hpp"

/// The one object that links gmsh, and with it a hundred libraries: loaded where a mesh file is read or written.
namespace palpate {
namespace {

constexpr int kTriangle = 2, kTetrahedron = 4;

// Child processes only: this state is never undone, the process ends.
void start_library() {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
}

std::vector<std::size_t> element_nodes(int type) {
  std::vector<std::size_t> elements, nodes;
  gmsh::model::mesh::getElementsByType(type, elements, nodes);
  return nodes;
}

void put_nodes(std::string& bytes) {
  std::vector<std::size_t> numbers;
  std::vector<double> coordinates, unused;
  gmsh::model::mesh::getNodes(numbers, coordinates, unused, -1, -1, false, false);
  put_all(bytes, numbers);
  put_all(bytes, coordinates);
  put_all(bytes, element_nodes(kTetrahedron));
}

std::string read(const std::string& file) {
  start_library();
  try {
    gmsh::merge(file);
  } catch (const std::string& reason) {
    throw std::runtime_error("the gmsh library refuses it: " + reason);
  }
  std::string answer;
  put_nodes(answer);
  put_all(answer, element_nodes(kTriangle));

  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  put(answer, groups.size());
  for (const auto& [dimension, number] : groups) {
    std::string name;
    gmsh::model::getPhysicalName(dimension, number, name);
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, number, entities);
    put(answer, dimension);
    put(answer, number);
    put_text(answer, name);
    put_all(answer, entities);
  }
  return answer;
}

std::string write(const LibraryModel& model, const std::string& file, const LibraryFormat& format) {
  start_library();
  gmsh::model::add("palpate");
  for (const LibraryEntity& e : model.entities) gmsh::model::addDiscreteEntity(e.dimension, e.number);
  const LibraryEntity& first = model.entities.front();
  gmsh::model::mesh::addNodes(first.dimension, first.number, model.node_numbers, model.coordinates);
  for (const LibraryEntity& e : model.entities)
    gmsh::model::mesh::addElementsByType(e.number, e.element_type, {}, e.nodes);
  for (const LibraryGroup& g : model.groups) {
    gmsh::model::addPhysicalGroup(g.dimension, g.entities, g.number);
    gmsh::model::setPhysicalName(g.dimension, g.number, g.name);
  }
  gmsh::option::setNumber("Mesh.SaveAll", format.by_group ? 0 : 1);
  gmsh::option::setNumber("Mesh.MshFileVersion", format.version);
  gmsh::option::setNumber("Mesh.Binary", format.binary ? 1 : 0);
  gmsh::write(file);
  return {};
}

std::string fill(const LibraryModel& surface, double size) {
  start_library();
  gmsh::model::add("palpate");
  gmsh::model::addDiscreteEntity(2, 1);
  gmsh::model::mesh::addNodes(2, 1, surface.node_numbers, surface.coordinates);
  gmsh::model::mesh::addElementsByType(1, kTriangle, {}, surface.entities.front().nodes);
  gmsh::model::geo::addSurfaceLoop({1}, 1);
  gmsh::model::geo::addVolume({1}, 1);
  gmsh::model::geo::synchronize();
  // Delaunay: unlike HXT it gives the same mesh in every process.
  gmsh::option::setNumber("Mesh.Algorithm3D", 1);
  gmsh::option::setNumber("Mesh.OptimizeThreshold", 0.5);
  gmsh::option::setNumber("Mesh.MeshSizeMax", size);
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
  gmsh::model::mesh::generate(3);
  std::string answer;
  put_nodes(answer);
  return answer;
}

}  // namespace
}  // namespace palpate

const palpate::LibraryCalls* palpate_gmsh_calls() {
  static constexpr palpate::LibraryCalls calls{palpate::read, palpate::write, palpate::fill};
  return &calls;
}
