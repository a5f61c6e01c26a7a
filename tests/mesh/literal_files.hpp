#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace palpate {

// One mesh in every format: node numbers 10, 3, 7, 5, 2, 8 in this order, 7 in no element; tetrahedra 9 and 4
// in this order, both in entity 1 where the format allows it; a triangle in group 7.
inline const std::string kGmsh1 = R"($NOD
6
10 0 0 0
3 1 0 0
7 9 9 9
5 0 1 0
2 0 0 1
8 1 1 1
$ENDNOD
$ELM
3
9 4 5 1 4 10 3 5 2
4 4 6 1 4 3 8 5 2
6 2 7 3 3 10 3 5
$ENDELM
)";

inline const std::string kGmsh2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
3 5 "left half"
2 7 "base"
$EndPhysicalNames
$Nodes
6
10 0 0 0
3 1 0 0
7 9 9 9
5 0 1 0
2 0 0 1
8 1 1 1
$EndNodes
$Elements
3
9 4 2 5 1 10 3 5 2
4 4 2 6 1 3 8 5 2
6 2 2 7 3 10 3 5
$EndElements
)";

inline const std::string kGmsh4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
3 5 "left half"
2 7 "base"
$EndPhysicalNames
$Entities
0 0 1 2
3 0 0 0 1 1 0 1 7 0
1 0 0 0 1 1 1 1 5 0
2 0 0 0 1 1 1 1 6 0
$EndEntities
$Nodes
3 6 2 10
3 2 0 2
10
3
0 0 0
1 0 0
2 3 1 1
7
9 9 9 0.5 0.5
3 1 0 3
5
2
8
0 1 0
0 0 1
1 1 1
$EndNodes
$Elements
3 3 4 9
3 1 4 1
9 10 3 5 2
3 2 4 1
4 3 8 5 2
2 3 2 1
6 10 3 5
$EndElements
)";

inline const std::string kVtk = R"(# vtk DataFile Version 3.0
literal
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 6 double
0 0 0
1 0 0
9 9 9
0 1 0
0 0 1
1 1 1
CELLS 2 10
4 0 1 3 4
4 1 5 3 4
CELL_TYPES 2
10
10
)";

inline const std::string kStl = R"(solid two
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex 1 0 0
vertex 1 1 0
vertex 0 1 0
endloop
endfacet
endsolid two
)";

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

/// Raw bytes of numbers; swapped for big-endian formats.
template <class T>
std::string raw(std::initializer_list<double> values, bool swapped = false) {
  std::string bytes;
  for (double v : values) {
    const T value = static_cast<T>(v);
    std::string one(reinterpret_cast<const char*>(&value), sizeof value);
    if (swapped) std::reverse(one.begin(), one.end());
    bytes += one;
  }
  return bytes;
}

inline const std::vector<std::array<double, 4>> kLiteralNodes{{10, 0, 0, 0}, {3, 1, 0, 0}, {7, 9, 9, 9},
                                                              {5, 0, 1, 0},  {2, 0, 0, 1}, {8, 1, 1, 1}};

inline std::string gmsh2_binary() {
  std::string f = "$MeshFormat\n2.2 1 8\n" + raw<int>({1}) + "\n$EndMeshFormat\n";
  f += "$PhysicalNames\n2\n3 5 \"left half\"\n2 7 \"base\"\n$EndPhysicalNames\n$Nodes\n6\n";
  for (const auto& n : kLiteralNodes) f += raw<int>({n[0]}) + raw<double>({n[1], n[2], n[3]});
  f += "\n$EndNodes\n$Elements\n3\n" + raw<int>({4, 2, 2, 9, 5, 1, 10, 3, 5, 2, 4, 6, 1, 3, 8, 5, 2});
  return f + raw<int>({2, 1, 2, 6, 7, 3, 10, 3, 5}) + "\n$EndElements\n";
}

inline std::string gmsh4_binary() {
  using Size = std::size_t;
  std::string f = "$MeshFormat\n4.1 1 8\n" + raw<int>({1}) + "\n$EndMeshFormat\n$Entities\n" + raw<Size>({0, 0, 1, 2});
  const auto entity = [](int number, int group) {
    return raw<int>({double(number)}) + raw<double>({0, 0, 0, 1, 1, 1}) + raw<Size>({1}) + raw<int>({double(group)}) +
           raw<Size>({0});
  };
  f += entity(3, 7) + entity(1, 5) + entity(2, 6) + "\n$EndEntities\n$Nodes\n" + raw<Size>({2, 6, 2, 10});
  const auto nodes = [](std::size_t begin, std::size_t end) {
    std::string numbers, points;
    for (std::size_t i = begin; i < end; ++i) {
      const auto& n = kLiteralNodes[i];
      numbers += raw<Size>({n[0]});
      points += raw<double>({n[1], n[2], n[3]});
    }
    return raw<Size>({double(end - begin)}) + numbers + points;
  };
  f += raw<int>({3, 2, 0}) + nodes(0, 2) + raw<int>({3, 1, 0}) + nodes(2, 6) + "\n$EndNodes\n$Elements\n";
  f += raw<Size>({3, 3, 4, 9}) + raw<int>({3, 1, 4}) + raw<Size>({1, 9, 10, 3, 5, 2});
  f += raw<int>({3, 2, 4}) + raw<Size>({1, 4, 3, 8, 5, 2}) + raw<int>({2, 3, 2}) + raw<Size>({1, 6, 10, 3, 5});
  return f + "\n$EndElements\n";
}

template <class Real>
std::string vtk_binary(const std::string& real) {
  std::string f = "# vtk DataFile Version 3.0\nliteral\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 " + real + "\n";
  for (const auto& n : kLiteralNodes) f += raw<Real>({n[1], n[2], n[3]}, true);
  f += "\nCELLS 2 10\n" + raw<int>({4, 0, 1, 3, 4, 4, 1, 5, 3, 4}, true);
  return f + "\nCELL_TYPES 2\n" + raw<int>({10, 10}, true) + "\n";
}

}  // namespace palpate
