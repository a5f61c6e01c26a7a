#include "common/mesh/cut_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/mesh/tet_mesh.hpp"

namespace palpate {

CutMesh::CutMesh(std::span<const std::array<int, 4>> tetrahedra, int nodes)
    : tetrahedra_(tetrahedra.begin(), tetrahedra.end()),
      first_around_(nodes + 1, 0),
      around_(4 * tetrahedra.size()),
      across_(4 * tetrahedra.size(), -1),
      alive_(tetrahedra.size(), 1),
      alive_around_(nodes, 0),
      alive_count_(static_cast<int>(tetrahedra.size())),
      place_(4 * tetrahedra.size(), -1),
      is_pending_(nodes, 0),
      group_(tetrahedra.size(), -1),
      from_(tetrahedra.size(), -1),
      depth_(tetrahedra.size(), 0),
      count_(nodes, 0),
      rim_(nodes, -1) {
  for (int t = 0; t < size(); ++t)
    for (int n : tetrahedra_[t]) {
      if (n < 0 || n >= nodes)
        throw std::runtime_error(fmt::format("tetrahedron {}: node {} does not exist, there are {}", t, n, nodes));
      ++alive_around_[n];
    }
  for (int n = 0; n < nodes; ++n) first_around_[n + 1] = first_around_[n] + alive_around_[n];
  std::vector<int> next(first_around_.begin(), first_around_.end() - 1);
  for (int t = 0; t < size(); ++t)
    for (int n : tetrahedra_[t]) around_[next[n]++] = t;
  join_faces();

  const int max_around = nodes > 0 ? *std::max_element(alive_around_.begin(), alive_around_.end()) : 0;
  for (auto* list : {&star_, &queue_, &group_size_}) list->reserve(max_around);
  for (auto* list : {&visible_, &appeared_, &vanished_}) list->reserve(4 * tetrahedra.size());
  killed_.reserve(tetrahedra.size());
  pending_.reserve(nodes);
  for (int id = 0; id < 4 * size(); ++id)
    if (across_[id] < 0) show(id);
  appeared_.clear();
}

void CutMesh::join_faces() {
  struct Face {
    std::array<int, 3> key;  // ascending
    int id;
    bool operator<(const Face& other) const { return key != other.key ? key < other.key : id < other.id; }
  };
  std::vector<Face> faces;
  faces.reserve(across_.size());
  for (int id = 0; id < 4 * size(); ++id) {
    Face face{facet(id), id};
    std::sort(face.key.begin(), face.key.end());
    faces.push_back(face);
  }
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
    if (faces[i].key != faces[i + 1].key) continue;
    if (across_[faces[i].id] >= 0)
      throw std::runtime_error(
          fmt::format("tetrahedron {}: its face with the nodes {}, {} and {} belongs to two others",
                      faces[i + 1].id / 4, faces[i].key[0], faces[i].key[1], faces[i].key[2]));
    across_[faces[i].id] = faces[i + 1].id;
    across_[faces[i + 1].id] = faces[i].id;
  }
}

std::array<int, 3> CutMesh::facet(int id) const {
  const auto& tet = tetrahedra_[id / 4];
  const auto& face = kTetFaces[id % 4];
  return {tet[face[0]], tet[face[1]], tet[face[2]]};
}

void CutMesh::remove(int t, std::vector<int>& removed) {
  killed_.clear();
  if (alive_[t]) kill(t);
  while (!pending_.empty()) {
    const int node = pending_.back();
    pending_.pop_back();
    is_pending_[node] = 0;
    while (repair(node)) {
    }
  }
  update_surface(killed_);
  removed.insert(removed.end(), killed_.begin(), killed_.end());
}

void CutMesh::erase(std::span<const int> tetrahedra) {
  killed_.clear();
  for (int t : tetrahedra)
    if (alive_[t]) kill(t);
  for (int node : pending_) is_pending_[node] = 0;
  pending_.clear();
  update_surface(killed_);
}

void CutMesh::kill(int t) {
  alive_[t] = 0;
  --alive_count_;
  killed_.push_back(t);
  for (int n : tetrahedra_[t]) {
    --alive_around_[n];
    if (is_pending_[n]) continue;
    is_pending_[n] = 1;
    pending_.push_back(n);
  }
}

void CutMesh::show(int facet) {
  place_[facet] = static_cast<int>(visible_.size());
  visible_.push_back(facet);
  appeared_.push_back(facet);
}

void CutMesh::hide(int facet) {
  const int last = visible_.back();
  visible_[place_[facet]] = last;
  place_[last] = place_[facet];
  visible_.pop_back();
  place_[facet] = -1;
  vanished_.push_back(facet);
}

void CutMesh::update_surface(std::span<const int> killed) {
  appeared_.clear();
  vanished_.clear();
  for (int t : killed)
    for (int id = 4 * t; id < 4 * t + 4; ++id) {
      if (place_[id] >= 0)
        hide(id);
      else if (!outside(id))
        show(across_[id]);
    }
}

int CutMesh::parts(std::vector<int>& part_of_tetrahedron) const {
  part_of_tetrahedron.assign(tetrahedra_.size(), -1);
  std::vector<int> queue;
  int count = 0;
  for (int first = 0; first < size(); ++first) {
    if (!alive_[first] || part_of_tetrahedron[first] >= 0) continue;
    part_of_tetrahedron[first] = count;
    queue.assign(1, first);
    while (!queue.empty()) {
      const int t = queue.back();
      queue.pop_back();
      for (int id = 4 * t; id < 4 * t + 4; ++id) {
        if (outside(id) || part_of_tetrahedron[across_[id] / 4] >= 0) continue;
        part_of_tetrahedron[across_[id] / 4] = count;
        queue.push_back(across_[id] / 4);
      }
    }
    ++count;
  }
  return count;
}

}  // namespace palpate
