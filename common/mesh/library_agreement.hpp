#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/mesh/gmsh_library.hpp"
#include "common/mesh/listing.hpp"

namespace palpate {

/// Throws std::runtime_error("FILE: reason").
[[noreturn]] void refuse_mesh(const std::filesystem::path& file, const std::string& reason);

/// What is said where a surface stands in a mesh's place.
inline constexpr const char* kMakesMesh = "`palpate mesh SURFACE -o organ.msh` makes one of it";

/// The library goes by the extension and takes unknown text for a script, so both have to fit. Refuses a
/// binary STL that ends before its last triangle. `surfaces_too`: .stl files pass.
void check_mesh_format(const std::filesystem::path& file, bool surfaces_too);

/// Refuses a scale that is not a positive number.
void check_mesh_scale(const std::filesystem::path& file, double scale);

/// read_with_library() with the file in its error sentences.
LibraryMesh ask_library(const std::filesystem::path& file);

/// The list of the file and the reading of the library must be the same mesh, whatever their order: refuses a
/// file where nodes or elements (`listed` by positions in the list of nodes, `read` by node numbers) differ.
/// For N = 3 and 4.
template <std::size_t N>
void check_agreement(const std::filesystem::path& file, const FileListing& listing,
                     const std::vector<std::array<int, N>>& listed, const LibraryMesh& library,
                     const std::vector<std::array<std::uint64_t, N>>& read);

/// The physical groups of a file, as load_tet_mesh() names them.
std::map<std::string, MeshGroup> named_groups(const FileListing& listing, const LibraryMesh& library);

}  // namespace palpate
